// Other libraries that decide predicates, each in the same form. Some have a source file with its
// own flags, if their library is installed.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string_view>

#include "tests/bench/harness.hpp"
#include "tests/bench/predicates/predicate_sets.hpp"

namespace bench {

#ifdef ERRBOUND_HAVE_CGAL
inline constexpr bool have_cgal = true;
#else
inline constexpr bool have_cgal = false;
#endif

#ifdef ERRBOUND_HAVE_TETGEN
inline constexpr bool have_tetgen = true;
#else
inline constexpr bool have_tetgen = false;
#endif

/// Times of algorithms made of predicates: constructions.cpp
void whole_constructions(bool quick, report& out);

/// Decides the first `count` inputs of a set.
template <class Form>
using decider = void (*)(const set_of<Form>&, std::size_t count, signs&);

/// CGAL's Exact_predicates_inexact_constructions_kernel.
template <class Form>
void decide_by_cgal(const set_of<Form>& set, std::size_t count, signs& out);
template <class Form>
void decide_by_shewchuk(const set_of<Form>& set, std::size_t count, signs& out);
/// Decides all inputs of a set, converted before; empty if CGAL does not have the predicate.
struct cgal_pass {
    std::function<void(signs&)> decide;
    bool only_negative = false;  ///< distinguishes negative signs from others, but no more
};
/// The passes of the exact predicates kernel and of the one with exact, lazy constructions.
template <std::size_t D, std::size_t N>
std::array<cgal_pass, 2> cgal_passes(std::string_view name, const input_set<D, N>& set);

}  // namespace bench
