// Predicates that are never zero, by symbolic perturbation (simulation of simplicity).
//   constexpr auto turn = errbound::perturbed(errbound::orient2d);
//   errbound::sign_type s = turn({4, 7, 9}, p, q, r);  // p has the index 4 in the program's list
//
// Coordinate k of the point with index i is x + e(i, k), for infinitesimals e > 0. All calls see
// the same perturbed points, so signs never contradict each other. A sign is zero only if arguments
// have the same index, or only some coordinates are perturbed. It is uncertain only if a coordinate
// is not finite. If the exact sign is zero, a call costs 1 to 20 µs (more for equal points) and
// allocates. Constructed points that coincide can take seconds and gigabytes; std::bad_alloc if
// memory runs out. Source: Edelsbrunner, Mücke 1990, Simulation of
// Simplicity. Proof: docs/authoring-predicates.md.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <errbound/integers/dyadic.hpp>
#include <errbound/integers/integer.hpp>
#include <errbound/predicate.hpp>
#include <vector>

namespace errbound {

namespace filters {

/// A product of powers of infinitesimals e_0 >> e_1 >> ..., each smaller than all powers of the one
/// before. Greater monomials are smaller numbers. Each exponent has a field of bits; that of the
/// last infinitesimal is the most significant.
template <std::size_t Count, int Degree>
struct monomial {
    static constexpr std::size_t field = std::bit_width(static_cast<unsigned>(Degree));
    static constexpr std::size_t per_word = 64 / field;
    static constexpr std::size_t words = (Count + per_word - 1) / per_word;
    std::array<std::uint64_t, words> exponents{};

    static constexpr monomial of(std::size_t infinitesimal) {
        monomial m;
        m.exponents[words - 1 - infinitesimal / per_word] = std::uint64_t{1}
                                                            << (infinitesimal % per_word * field);
        return m;
    }
    /// No field overflows, since no product exceeds the expression's degree.
    friend constexpr monomial operator*(monomial x, const monomial& y) {
        for (std::size_t i = 0; i < words; ++i) x.exponents[i] += y.exponents[i];
        return x;
    }
    friend constexpr bool operator==(const monomial&, const monomial&) = default;
    friend constexpr bool operator<(const monomial& x, const monomial& y) {
        return x.exponents < y.exponents;
    }
};

/// Terms of all polynomials of one evaluation. `complete` is true if no infinitesimal is skipped.
template <class Coefficient, class Monomial>
struct term_store {
    struct term {
        Monomial powers;
        Coefficient coefficient;
    };
    std::vector<term> terms;
    bool complete = false;
};

/// A polynomial in infinitesimals: terms in ascending order of monomials, with nonzero
/// coefficients. Its sign is that of the first term.
template <class Coefficient, class Monomial>
class infinitesimal_polynomial {
    using store = term_store<Coefficient, Monomial>;

  public:
    infinitesimal_polynomial(store& s, const Coefficient& c) : infinitesimal_polynomial(s) {
        add(Monomial(), c);
    }
    /// c + e
    infinitesimal_polynomial(store& s, const Coefficient& c, std::size_t infinitesimal)
        : infinitesimal_polynomial(s, c) {
        add(Monomial::of(infinitesimal), whole(1));
    }

    infinitesimal_polynomial operator-() const { return number(0) - *this; }
    friend infinitesimal_polynomial operator+(const infinitesimal_polynomial& x,
                                              const infinitesimal_polynomial& y) {
        return x.template combined<false>(y);
    }
    friend infinitesimal_polynomial operator-(const infinitesimal_polynomial& x,
                                              const infinitesimal_polynomial& y) {
        return x.template combined<true>(y);
    }
    friend infinitesimal_polynomial operator*(const infinitesimal_polynomial& x,
                                              const infinitesimal_polynomial& y) {
        infinitesimal_polynomial r(*x.store_);
        auto& terms = x.store_->terms;
        terms.reserve(terms.size() + x.count_ * y.count_);
        for (std::size_t i = x.first_; i < x.first_ + x.count_; ++i)
            for (std::size_t j = y.first_; j < y.first_ + y.count_; ++j)
                r.add(terms[i].powers * terms[j].powers,
                      terms[i].coefficient * terms[j].coefficient);
        if (x.count_ > 1 && y.count_ > 1) r.sort();
        return r;
    }
    friend infinitesimal_polynomial operator+(const infinitesimal_polynomial& x,
                                              std::same_as<int> auto c) {
        return x + x.number(c);
    }
    friend infinitesimal_polynomial operator+(std::same_as<int> auto c,
                                              const infinitesimal_polynomial& x) {
        return x + c;
    }
    friend infinitesimal_polynomial operator-(const infinitesimal_polynomial& x,
                                              std::same_as<int> auto c) {
        return x - x.number(c);
    }
    friend infinitesimal_polynomial operator-(std::same_as<int> auto c,
                                              const infinitesimal_polynomial& x) {
        return x.number(c) - x;
    }
    friend infinitesimal_polynomial operator*(const infinitesimal_polynomial& x,
                                              std::same_as<int> auto c) {
        return x * x.number(c);
    }
    friend infinitesimal_polynomial operator*(std::same_as<int> auto c,
                                              const infinitesimal_polynomial& x) {
        return x * c;
    }
    /// Terms with a skipped infinitesimal come after all others. So the first term, if there is
    /// one, is final; otherwise the sign is uncertain, or zero if nothing was skipped.
    friend sign_type sign_of(const infinitesimal_polynomial& x) {
        if (x.count_ == 0) return x.store_->complete ? sign_type::zero : sign_type::uncertain;
        return sign_of_coefficient(x.store_->terms[x.first_].coefficient);
    }

  private:
    explicit infinitesimal_polynomial(store& s) : store_(&s), first_(s.terms.size()) {}
    infinitesimal_polynomial number(int c) const { return {*store_, whole(c)}; }
    static Coefficient whole(int c) {
        if constexpr (requires { Coefficient::from(c); })
            return Coefficient::from(c);
        else
            return c;
    }
    static bool is_zero(const Coefficient& c) { return sign_of_coefficient(c) == sign_type::zero; }
    static sign_type sign_of_coefficient(const Coefficient& c) {
        if constexpr (requires { sign_of(c); })
            return sign_of(c);
        else
            return c > 0 ? sign_type::positive : c < 0 ? sign_type::negative : sign_type::zero;
    }

    /// Appends a term to this polynomial, the last in the store.
    void add(const Monomial& m, const Coefficient& c) {
        if (is_zero(c)) return;
        store_->terms.push_back({m, c});
        ++count_;
    }
    template <bool Subtract>
    infinitesimal_polynomial combined(const infinitesimal_polynomial& y) const {
        infinitesimal_polynomial r(*store_);
        auto& terms = store_->terms;
        terms.reserve(terms.size() + count_ + y.count_);
        std::size_t i = first_, j = y.first_;
        const std::size_t end = first_ + count_, y_end = y.first_ + y.count_;
        while (i < end || j < y_end) {
            const bool of_x = j == y_end || (i < end && !(terms[j].powers < terms[i].powers));
            const bool of_y = i == end || (j < y_end && !(terms[i].powers < terms[j].powers));
            const Monomial m = terms[of_x ? i : j].powers;
            const Coefficient a = of_x ? terms[i++].coefficient : whole(0);
            const Coefficient b = of_y ? terms[j++].coefficient : whole(0);
            r.add(m, Subtract ? Coefficient(a - b) : Coefficient(a + b));
        }
        return r;
    }
    /// Sorts the terms and adds those of equal monomials. This polynomial is the last in the store.
    void sort() {
        auto& terms = store_->terms;
        const auto begin = terms.begin() + static_cast<std::ptrdiff_t>(first_);
        std::sort(begin, terms.end(),
                  [](const auto& s, const auto& t) { return s.powers < t.powers; });
        auto end = begin;
        for (auto t = begin; t != terms.end();) {
            auto sum = *t++;
            for (; t != terms.end() && t->powers == sum.powers; ++t)
                sum.coefficient = sum.coefficient + t->coefficient;
            if (!is_zero(sum.coefficient)) *end++ = sum;
        }
        terms.erase(end, terms.end());
        count_ = terms.size() - first_;
    }

    store* store_;
    std::size_t first_, count_ = 0;
};

}  // namespace filters

/// A predicate over perturbed points. See perturbed().
template <class Predicate, int... Coordinates>
class perturbed_predicate;
template <class Shape, class F, class Options, int... Coordinates>
class perturbed_predicate<predicate_type<Shape, F, Options>, Coordinates...> {
    static_assert(!filters::branches<Shape, F> || filters::is_sign_of_fraction<F>,
                  "errbound: perturbed needs an expression that returns a number; one that "
                  "branches or returns sign_of(x) may be zero, or take another branch, for "
                  "perturbed points: perturb the predicates that it combines");
    static_assert(
        ((Coordinates >= 0 && Coordinates < *std::ranges::max_element(Shape::dimensions)) && ...),
        "errbound: perturbed has the index of a coordinate that no point has");
    using predicate = predicate_type<Shape, F, Options>;
    using stages = filters::predicate_stages<Shape, F, Options>;
    using monomial = filters::monomial<Shape::size, predicate::counts.degree>;

  public:
    using index_list = std::array<std::size_t, Shape::count>;

    /// Returns the sign for the points with these indices: a braced list or an array. Precondition:
    /// points of equal index are equal.
    template <std::size_t Count, class... Points>
    sign_type operator()(const std::size_t (&indices)[Count], const Points&... p) const {
        return (*this)(std::to_array(indices), p...);
    }
    template <std::size_t Count, class... Points>
    sign_type operator()(const std::array<std::size_t, Count>& indices, const Points&... p) const {
        static_assert(Count == Shape::count,
                      "errbound: perturbed takes one index for each point of the predicate's "
                      "shape");
        static_assert(!(filters::is_constructed<Points> || ...),
                      "errbound: perturbed takes explicit points; for constructed ones perturb the "
                      "predicate of their parents: "
                      "perturbed(with_constructed<line_line, given, given>(orient2d))");
        if constexpr (Count == Shape::count && !(filters::is_constructed<Points> || ...)) {
            const sign_type s = predicate()(p...);
            if (s != sign_type::zero) [[likely]]
                return s;
            return perturbed_sign(indices, stages::listed(p...));
        } else {
            return sign_type::uncertain;
        }
    }

  private:
    using coordinate_list = typename stages::coordinate_list;
    static constexpr std::size_t none = Shape::size;

    /// The rank of each coordinate's infinitesimal, or none. A smaller index means a larger
    /// infinitesimal; in a point, the last coordinate has the largest.
    static std::array<std::size_t, Shape::size> ranks(const index_list& indices,
                                                      std::size_t& count) {
        index_list sorted = indices;
        std::sort(sorted.begin(), sorted.end());
        std::array<std::size_t, Shape::size> rank;
        rank.fill(none);
        count = 0;
        for (std::size_t i = 0; i < Shape::count; ++i) {
            if (i > 0 && sorted[i] == sorted[i - 1]) continue;
            constexpr std::size_t widest = [] {
                int most = 1;
                for (const int d : Shape::dimensions) most = (std::max)(most, d);
                return static_cast<std::size_t>(most);
            }();
            for (std::size_t k = widest; k-- > 0;) {
                if (sizeof...(Coordinates) > 0 && !((k == Coordinates) || ...)) continue;
                bool used = false;
                for (std::size_t a = 0; a < Shape::count; ++a) {
                    const int d = Shape::dimensions[a];
                    if (indices[a] != sorted[i] || k >= static_cast<std::size_t>(d == 0 ? 1 : d))
                        continue;
                    rank[Shape::offset(a) + k] = count;
                    used = true;
                }
                count += used;
            }
        }
        return rank;
    }

    [[gnu::noinline]] static sign_type perturbed_sign(const index_list& indices,
                                                      const coordinate_list& list) {
        std::size_t count = 0;
        const auto rank = ranks(indices, count);
#ifdef __SIZEOF_INT128__
        // A coordinate plus an infinitesimal counts as one bit more: the sum of the magnitudes of a
        // polynomial's coefficients obeys the bounds that hold for numbers.
        const integers::common_unit unit(list);
        if (!stages::mixed && unit.bits < stages::coordinate_bits(127)) {
            using level = integers::integer_level<integers::integer_kind::words, stages::word_bits,
                                                  /*Mixed=*/false>;
            using word = integers::words::signed_double_word;
            return over<word>(list, rank, count, [&](double x) {
                return word{unit.template converted<level>(x).value};
            });
        }
#endif
        using number = dyadic<integer>;
        return over<number>(list, rank, count, [](double x) { return number::from(x); });
    }
    /// Includes the largest infinitesimals only, then twice as many until a sign is certain.
    template <class Coefficient, class Make>
    static sign_type over(const coordinate_list& list,
                          const std::array<std::size_t, Shape::size>& rank, std::size_t count,
                          const Make& make) {
        using number = filters::infinitesimal_polynomial<Coefficient, monomial>;
        filters::term_store<Coefficient, monomial> store;
        store.terms.reserve(256);
        for (std::size_t included = 1;; included *= 2) {
            store.complete = included >= count;
            store.terms.clear();
            const sign_type s = filters::sign_over<Shape>(F(), list, [&](const double& x) {
                const auto i = static_cast<std::size_t>(&x - list.data());
                return rank[i] < (std::min)(included, count) ? number(store, make(x), rank[i])
                                                             : number(store, make(x));
            });
            if (certain(s)) return s;
        }
    }
};

/// The predicate over perturbed points. Its expression must return a number, or be one of
/// with_constructed. Template arguments are the indices of the coordinates to perturb, 0 for plain
/// numbers; without any, all are. perturbed<3>(power_insphere) perturbs only weights, so no flat
/// simplex gets a positive volume. The sign may then be zero (if all five points are coplanar).
template <int... Coordinates, class Shape, class F, class Options>
constexpr perturbed_predicate<predicate_type<Shape, F, Options>, Coordinates...> perturbed(
    const predicate_type<Shape, F, Options>&) {
    return {};
}

}  // namespace errbound
