// Isolates the roots of a square-free polynomial between two positive points, by Descartes' rule on
// intervals (Vincent, Collins, Akritas; in Bernstein form: Lane, Riesenfeld 1981).
//
// Bernstein coefficients without sign change exclude a root inside an interval; one change proves
// exactly one; other intervals are split. This ends by the two-circle theorem (Krandick, Mehlhorn
// 2006). If halving keeps all roots in one half, Newton's method for a multiple root locates the
// cluster. If Descartes' rule excludes roots outside an interval around it, that interval is kept.
// The next narrowing squares its factor (Sagraloff, Mehlhorn, J. Symb. Comp. 73, 2016).
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <errbound/roots/fixed_row.hpp>
#include <errbound/roots/integer_polynomial.hpp>
#include <errbound/roots/local_form.hpp>
#include <errbound/roots/prime_field.hpp>
#include <errbound/roots/sign_variations.hpp>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace errbound {

/// One root: low = high is the root, or it is the only one in [low, high] and strictly inside.
template <exact_number Integer>
struct isolating_interval {
    dyadic<Integer> low, high;
    int multiplicity = 1;

    bool is_point() const { return low == high; }
};

}  // namespace errbound

namespace errbound::roots {

/// Returns 45/32·2^exponent. Unlike powers of two, it is rarely a root in practice, and neither are
/// the points that halving makes from it.
template <class Integer>
dyadic<Integer> unlikely_root(int exponent) {
    return {Integer(45), exponent - 5};
}

/// A zero in (0, 1) of the derivative of the polynomial with control values b, by Newton's method.
/// On failure the result is outside (0, 1).
inline double extremum(const std::vector<double>& b) {
    const std::size_t n = b.size() - 1;
    std::vector<double> slopes(n);
    double t = 0.5;
    for (int i = 0; i < 8 && 0 < t && t < 1; ++i) {
        for (std::size_t j = 0; j < n; ++j) slopes[j] = b[j + 1] - b[j];
        for (std::size_t left = n; left > 2; --left)
            for (std::size_t j = 0; j + 1 < left; ++j)
                slopes[j] = (1 - t) * slopes[j] + t * slopes[j + 1];
        const double bend = slopes[1] - slopes[0];
        t -= (slopes[0] + t * bend) / (bend * static_cast<double>(n - 1));
    }
    return t;
}

template <exact_number Integer>
class descartes_search {
  public:
    using form = integer_form<Integer>;
    using point = dyadic<Integer>;
    using interval = isolating_interval<Integer>;

    /// p, square-free, and the meter must outlive this.
    descartes_search(const form& p, work_meter& meter) : p_(p), meter_(meter) {}

    struct end {
        point at;
        bool is_root;
    };

    /// Appends the roots strictly between low and high, ascending. Precondition: 0 < low < high.
    /// Bounded stack. Proof: proofs/roots/RootIsolation.v, on_part_right.
    void find(const end& low, const end& high, std::vector<interval>& roots) {
        add({low.at, high.at, low.is_root, high.is_root});
        while (!parts_.empty()) {
            part next = std::move(parts_.back());
            parts_.pop_back();
            if (next.low == next.high || (next.variations == 1 && !next.has_root_at_end()))
                roots.push_back({std::move(next.low), std::move(next.high)});
            else
                divide(std::move(next));
        }
    }

  private:
    struct part {
        point low = {}, high = {};
        bool root_at_low = false, root_at_high = false;
        int variations = 3;  ///< as max_sign_variations counts
        int halvings = 0;
        int lone_halvings = 0;  ///< the latest halvings, which left all roots in this part
        int speed = slowest;    ///< log2 of the factor by which Newton's method narrows it
        int bits = row_bits;    ///< requested of the local form
        std::optional<fixed_row<4>> row = {};
        std::optional<local_form<Integer>> local = {};

        bool has_root_at_end() const { return root_at_low || root_at_high; }
        bool low_end_is_certain() const {
            return row ? row->sign(0) != 0 : local && local->low_end_is_certain();
        }
    };
    static constexpr int slowest = 8, row_bits = 256, lone = 32, most_bits = 1 << 28,
                         most_lost_bits = 1 << 20;

    void add(part p) {
        count_variations(p);
        if (p.variations > 0) parts_.push_back(std::move(p));
    }

    /// Returns a bound on the sign changes of a row. Skips an end coefficient that is zero because
    /// of a root there. Returns nothing if the first or last coefficient of the rest has an
    /// uncertain sign.
    template <class Sign>
    static std::optional<int> variations(const part& p, std::size_t size, const Sign& sign) {
        const std::size_t first = p.root_at_low ? 1 : 0,
                          count = size - first - (p.root_at_high ? 1 : 0);
        if (count == 0) return 0;
        if (sign(first) == 0 || sign(first + count - 1) == 0) return {};
        return max_sign_variations(count, [&](std::size_t i) { return int(sign(first + i)); });
    }
    static std::optional<int> variations_of_local(const part& p, int bits) {
        const auto signs = p.local->signs(bits);
        return variations(p, signs.size(), [&](std::size_t i) { return signs[i]; });
    }
    static std::optional<int> variations_of_row(const part& p) {
        return variations(p, p.row->size(), [&](std::size_t i) { return p.row->sign(i); });
    }
    /// Sets p.variations from Bernstein coefficients, which p keeps for halving. They are exact if
    /// short; otherwise they have enough bits for certain signs at both ends.
    void count_variations(part& p) {
        std::optional<int> found;
        if (p.row) {
            found = variations_of_row(p);
        } else if (!p.local && exact_row_is_cheap(p)) {
            const int range = floor_log2(p.high) - floor_log2(p.low) + bits_of_ends(p);
            charge(static_cast<std::int64_t>(p_.size()) * range);
            const form b = control_values_on(p_, p.low, p.high, meter_);
            found = sign_variations(b.size(), [&](std::size_t i) { return sign(b[i]); });
            if (*found > 1) {
                p.row.emplace(b, Integer(0));
                if (!variations_of_row(p)) p.row = {};
            }
        }
        if (!found) p.row = {};
        if (!found && !p.local && varies_too_much(p)) return;
        for (; !found; p.bits *= 2) {
            if (!p.local || p.local->bits() < p.bits) expand(p);
            if (!p.root_at_low && !p.local->low_end_is_certain()) continue;
            if (!p.root_at_high && !p.local->high_end_is_certain()) continue;
            if (p.speed == slowest) {
                const auto b = p.local->coefficients(row_bits);
                p.row.emplace(b.values, b.error);
                found = variations_of_row(p);
            } else {
                found = variations_of_local(p, row_bits);
            }
            if (found) break;
            p.row = {};
            found = variations_of_local(p, (std::numeric_limits<int>::max)());
            if (found) break;
        }
        p.variations = *found;
        if (p.row) p.local = {};
    }
    static int bits_of_ends(const part& p) {
        return (std::max)(floor_log2(p.low.numerator()), floor_log2(p.high.numerator())) + 1;
    }
    /// True if conversion to exact Bernstein coefficients adds at most about 2048 bits.
    bool exact_row_is_cheap(const part& p) const {
        return p_.size() <= 40 && static_cast<int>(p_.size()) * bits_of_ends(p) <= 2048;
    }
    /// True if the coefficients' sizes differ too much to count. Then 3 sign changes are assumed.
    bool varies_too_much(const part& p) const {
        return floor_log2(p.high) > floor_log2(p.low) + 1 &&
               local_form<Integer>::precision(p_.size(), p.low, p.high - p.low, 0) > most_lost_bits;
    }
    void expand(part& p) {
        const point width = p.high - p.low;
        charge(local_form<Integer>::precision(p_.size(), p.low, width, p.bits));
        p.local.emplace(p_, p.low, width, p.bits, &meter_);
    }
    /// Adds the cost of a row of n numbers with this many bits to the meter: its memory, n products
    /// and n² sums.
    void charge(std::int64_t bits) {
        const std::uint64_t n = p_.size(), words = static_cast<std::uint64_t>(bits) / 64 + 1;
        meter_.hold(8 * n * (4 * words + 8 * (parts_.size() + 1)));
        meter_.spend(n * (n + words / 4) * words);
    }

    void divide(part whole) {
        // Halve the exponents of wide parts, so that roots far apart in size take few steps.
        const int low_exponent = floor_log2(whole.low), high_exponent = floor_log2(whole.high);
        const int exponents = high_exponent - low_exponent;
        const auto between = [&] { return unlikely_root<Integer>(low_exponent + exponents / 2); };
        if (whole.row && whole.variations == 2 && exponents < 40 && divided_as_pair(whole)) return;
        if (exponents >= 12) {
            split(std::move(whole), between());
            return;
        }
        if (near_each_other(whole) && narrowed(whole)) return;
        if (whole.row) {
            meter_.spend(2 * p_.size() * p_.size());
            auto halves = std::move(*whole.row).halves();
            const point x = half(whole);
            split(std::move(whole), x, {.row = std::move(halves.first)},
                  {.row = std::move(halves.second)});
        } else if (whole.local && whole.local->ends_are_alike()) {
            charge(whole.local->bits());
            auto left = whole.local->part(Integer(0), Integer(1), 1),
                 right = whole.local->part(Integer(1), Integer(1), 1);
            const point x = half(whole);
            split(std::move(whole), x, {.local = std::move(left)}, {.local = std::move(right)});
        } else {
            const point x = exponents > 1 ? between() : half(whole);
            split(std::move(whole), x);
        }
    }
    static point half(const part& p) { return middle(p.low, p.high); }
    /// True if all roots may be close together: after 32, 64, ... lone halvings, and after
    /// narrowed() succeeded.
    static bool near_each_other(const part& p) {
        const auto n = static_cast<unsigned>(p.lone_halvings);
        return p.speed > slowest || (n >= lone && std::has_single_bit(n));
    }
    /// Replaces a part by two, counting the sign changes of both.
    void split(part whole, point x, part left = {}, part right = {}) {
        const bool root_between = !right.low_end_is_certain() && is_root(x);
        left.low = std::move(whole.low);
        left.root_at_low = whole.root_at_low;
        right.high = std::move(whole.high);
        right.root_at_high = whole.root_at_high;
        left.root_at_high = right.root_at_low = root_between;
        left.high = right.low = x;
        for (part* half : {&left, &right}) {
            half->halvings = whole.halvings + 1;
            half->bits = whole.bits;
            half->speed = whole.speed;
            count_variations(*half);
        }
        if (!root_between && (left.variations == 0 || right.variations == 0))
            left.lone_halvings = right.lone_halvings = whole.lone_halvings + 1;
        else
            left.speed = right.speed = slowest;
        // The last part is processed first.
        if (right.variations > 0) parts_.push_back(std::move(right));
        if (root_between) parts_.push_back({x, x});
        if (left.variations > 0) parts_.push_back(std::move(left));
    }

    /// Estimated position of a part's roots, in units of 2^(−depth) of its width, and their number.
    struct place {
        Integer from;
        int roots;
    };
    /// Uses f/f' at both ends x, about (x − position)/roots.
    static std::optional<place> place_of_roots(const local_form<Integer>& local, int depth) {
        const auto cut = [&](Integer& a, Integer& b) {
            const Integer size = (std::max)(Integer(abs(a)), Integer(abs(b)));
            const int excess = size == 0 ? 0 : floor_log2(size) - (depth + 64);
            if (excess <= 0) return;
            a = shifted(a, -excess);
            b = shifted(b, -excess);
        };
        Integer f0 = local.value_at_start(), slope0 = local.slope_at_start();
        Integer f1 = local.value_at_end(), slope1 = local.slope_at_end();
        cut(f0, slope0);
        cut(f1, slope1);
        const Integer distance = -f0 * slope1, sum = f1 * slope0 + distance, both = slope0 * slope1;
        if (sum == 0) return {};
        const Integer roots = both / sum;
        return place{Integer((distance << static_cast<unsigned>(depth)) / sum),
                     roots > 0 && roots < local.degree() ? static_cast<int>(roots) + 1 : 1};
    }
    bool narrowed(part& whole) {
        const int depth = whole.speed + 2;
        if (!whole.local) expand(whole);
        auto found = place_of_roots(*whole.local, depth);
        const Integer pieces = Integer(1) << static_cast<unsigned>(depth);
        const auto inside = [&] { return found && -1 <= found->from && found->from <= pieces; };
        for (int tries = 0; tries < 3 && inside(); ++tries) {
            const std::int64_t wanted = std::int64_t(found->roots) * whole.speed + 64;
            const int bits = whole.local->certain_bits();
            if (bits >= wanted) break;
            if (wanted > most_bits) return false;
            whole.bits = whole.local->bits() + static_cast<int>(wanted) - bits + 64;
            expand(whole);
            found = place_of_roots(*whole.local, depth);
        }
        if (inside() && narrowed(whole, *found, depth, pieces)) return true;
        whole.speed = (std::max)(slowest, whole.speed / 2);
        return false;
    }
    bool narrowed(const part& whole, const place& found, int depth, const Integer& pieces) {
        const Integer from = (std::max)(Integer(0), Integer(found.from - 1)),
                      to = (std::min)(pieces, Integer(found.from + 2));
        charge(whole.local->bits());
        const point width = whole.high - whole.low;
        const auto piece = [&](const Integer& a, const Integer& b) {
            part p{whole.low + width * point(a, -depth), whole.low + width * point(b, -depth)};
            p.root_at_low = a == 0 && whole.root_at_low;
            p.root_at_high = b == pieces && whole.root_at_high;
            p.local = whole.local->part(a, Integer(b - a), depth);
            return p;
        };
        if (from > 0 && !piece(Integer(0), from).local->surely_rootless()) return false;
        if (to < pieces && !piece(to, pieces).local->surely_rootless()) return false;
        part narrow = piece(from, to);
        narrow.halvings = whole.halvings + depth;
        narrow.lone_halvings = whole.lone_halvings;
        narrow.speed = (std::min)(2 * whole.speed, most_bits);
        narrow.bits = whole.bits;
        add(std::move(narrow));
        return true;
    }

    /// Splits a part with two sign changes at its extremum, since halving separates two close roots
    /// slowly. Newton's method with growing precision finds the extremum. Real roots are then on
    /// both sides. Two complex roots are outside both circles that have a side as diameter, so
    /// neither side has a sign change. Tried after 0, 8, 16, 32, ... halvings. Proof:
    /// proofs/roots/SignVariations.v, two_variations_two_roots.
    bool divided_as_pair(part& whole) {
        if (whole.has_root_at_end() || whole.halvings % 8 != 0 ||
            (whole.halvings & (whole.halvings - 1)) != 0)
            return false;
        const double t = extremum(whole.row->nearby_values());
        if (!(0 < t && t < 1)) return false;
        if (slope_.empty()) {
            slope_ = derivative(p_);
            curvature_ = derivative(slope_);
        }
        const sign_type at_ends =
            whole.row->sign(0) < 0 ? sign_type::negative : sign_type::positive;
        point x = whole.low + (whole.high - whole.low) * point::from(t);
        for (int bits = 64;; bits *= 2) {
            const point value = value_at(p_, x, meter_);
            if (value.is_zero()) return false;
            if (sign_of(value) == -at_ends) {
                part right{x, whole.high}, left{whole.low, x};
                left.variations = right.variations = 1;
                parts_.push_back(std::move(right));
                parts_.push_back(std::move(left));
                return true;
            }
            const point rise = value_at(slope_, x, meter_), bend = value_at(curvature_, x, meter_);
            // The parabola's extremum is on the same side as p(x) if p·p'' > p'²/2.
            if (bits > 256 || rise.is_zero() || bend.is_zero() ||
                rise * rise < magnitude(value * bend))
                break;
            x = x - quotient(rise, bend, bits);
            if (!(whole.low < x && x < whole.high)) return false;
        }
        split(std::move(whole), std::move(x));
        return true;
    }

    /// Tests modulo a prime first, since few nonzero values are multiples of the prime.
    bool is_root(const point& x) {
        if (residues_.empty()) residues_ = residues(p_, field_);
        return value_at(residues_, field_, x) == 0 && sign_at(p_, x, meter_) == sign_type::zero;
    }

    const form& p_;
    work_meter& meter_;
    const prime_field field_{large_primes[0]};
    std::vector<std::uint64_t> residues_;
    form slope_ = {}, curvature_ = {};
    std::vector<part> parts_;  ///< descending; processed from the last, the leftmost
};

}  // namespace errbound::roots
