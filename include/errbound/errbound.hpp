// Numbers, predicates and roots: what most programs take of errbound, and what needs nothing but
// the standard library. By themselves are printing.hpp, which brings streams along;
// explain/explain.hpp, where an error comes from; binary128.hpp and multiprecision.hpp; rules that
// few compute with (rules/affine.hpp, relative.hpp, stochastic.hpp), and derived.hpp for rules of
// your own; and what needs Eigen (eigen.hpp, certified_solve.hpp) or MPFR (validation/).
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
