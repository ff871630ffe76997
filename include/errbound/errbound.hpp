// Numbers, predicates and roots: all of errbound that needs only the standard library. Include
// separately: printing.hpp (streams); explain/explain.hpp (sources of an error); binary128.hpp and
// multiprecision.hpp; the rules affine.hpp, relative.hpp, stochastic.hpp and derived.hpp in rules/;
// eigen.hpp and certified_solve.hpp (Eigen); validation/ (MPFR).
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
#include <errbound/predicates/constructed_points.hpp>
#include <errbound/predicates/perturbation.hpp>
#include <errbound/roots/real_roots.hpp>
#include <errbound/simplices/common_segment.hpp>
#include <errbound/simplices/predicates.hpp>
#include <errbound/simplices/relation.hpp>
#include <errbound/small_floats.hpp>
#include <errbound/tracked.hpp>
