// Everything of errbound that needs nothing but the standard library; printing.hpp, which brings
// streams along, is by itself.
#pragma once

#include <errbound/bernstein.hpp>
#include <errbound/bsc.hpp>
#include <errbound/conversion.hpp>
#include <errbound/decimal.hpp>
#include <errbound/elementary.hpp>
#include <errbound/environment.hpp>
#include <errbound/functions.hpp>
#include <errbound/polynomial.hpp>
#include <errbound/predicate_batch.hpp>
#include <errbound/predicates.hpp>
#include <errbound/roots/real_roots.hpp>
#include <errbound/small_floats.hpp>
#include <errbound/tracked.hpp>
