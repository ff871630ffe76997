// The bound: let v(t) be the values if every operation i adds t times its actual error e_i, for t
// from 0 (exact) to 1 (computed). Then computed − exact = Σ e_i ∫ A_i(t) dt, with A_i(t) the
// derivative of the result by value i at v(t). So Σ ε_i max |A_i| bounds it, if ε_i bounds |e_i|
// and A_i is enclosed over the inputs and over all |e| <= ε. There is no remainder. Boxes are
// bisected, those of the largest bound first.
#include <chrono>
#include <cmath>
#include <optional>

#include "errbound/validation/worst_case/largest_error.hpp"
#include "errbound/validation/worst_case/range.hpp"

namespace errbound::validation {
namespace {

using std::size_t;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double doubles_underflow = std::numeric_limits<double>::denorm_min();

/// Rounding in a number format, by doubles.
struct number_format {
    int digits = 0, min_exponent = 0;
    double largest = 0;
    int function_digits = 0, function_min_exponent = 0;  ///< of the type that computes functions
    std::array<double, named_functions.size()> units{};  ///< function_error in that type

    template <class T>
    static number_format of(double units) {
        using wide = detail::function_type<T>;
        number_format f{number_traits<T>::digits,
                        number_traits<T>::min_exponent,
                        static_cast<double>(number_traits<T>::largest()),
                        number_traits<wide>::digits,
                        number_traits<wide>::min_exponent,
                        {}};
        if constexpr (!fits_double<T>) f.largest = std::numeric_limits<double>::max();
        [&]<size_t... I>(std::index_sequence<I...>) {
            ((f.units[I] =
                  units > 0 ? units : function_error<static_cast<elementary_function>(I), wide>),
             ...);
        }
        (std::make_index_sequence<named_functions.size()>());
        return f;
    }
    bool is_double() const { return digits == std::numeric_limits<double>::digits; }

    /// The error of rounding any |x| <= most to nearest with `d` digits. The second case: just
    /// above a power of two, which is a number of the format, the distance from it counts.
    static double half_ulp(double most, int d, int least_exponent) {
        if (!(most > 0)) return 0;
        if (!(most < infinity)) return infinity;
        int e = 0;
        const bool power = std::frexp(most, &e) == 0.5;
        const auto half = [&](int exponent) {
            return std::ldexp(1, std::max(std::max(exponent, least_exponent) - d - 1, -1074));
        };
        if (power || e <= least_exponent) return half(power ? e - 1 : e);
        return std::max(half(e - 1), std::min(half(e), most - std::ldexp(1, e - 1)));
    }
    double half_ulp(double most) const { return half_ulp(most, digits, min_exponent); }
    /// k units in the last place of any |x| <= most.
    double function_error_of(elementary_function f, double most) const {
        const double k = units[static_cast<size_t>(f)];
        int e = 0;
        std::frexp(most, &e);
        const double unit =
            std::ldexp(1, std::max(std::max(e, function_min_exponent) - function_digits, -1074));
        const double own = k > 0 ? k * unit * (1 + 0x1p-50) + doubles_underflow : infinity;
        return digits == function_digits ? own : own + half_ulp((most + own) * (1 + 0x1p-50));
    }
    /// The number of the format nearest to x; x if the format has at least a double's digits.
    double nearest(double x) const {
        if (digits >= std::numeric_limits<double>::digits || x == 0 || !std::isfinite(x)) return x;
        const int unit = std::max(std::ilogb(x) + 1, min_exponent) - digits;
        return std::ldexp(std::nearbyint(std::ldexp(x, -unit)), unit);
    }
    /// g such that all numbers of the format in x are multiples of 2^g.
    int grid_of(const range& x) const {
        int e = min_exponent;
        if (x.least() > 0) std::frexp(x.least(), &e);
        return std::max(e, min_exponent) - digits;
    }
};

bool is_power_of_two(double x) {
    int e = 0;
    return std::isfinite(x) && std::abs(std::frexp(x, &e)) == 0.5;
}

/// A node over a box.
struct node_state {
    range computed;               ///< the computed values
    range path;                   ///< all v(t)
    double error = 0;             ///< ε
    int grid = 0;                 ///< computed values are multiples of 2^grid
    std::array<range, 3> slopes;  ///< by the operands
    range curvature_left, curvature_both, curvature_right;
    range adjoint, tangent, pull;
};
using states = std::vector<node_state>;

class analysis {
  public:
    explicit analysis(const recording& f)
        : f_(f), format_(with_number_type(f.type, [&]<class T>() {
              return number_format::of<T>(f.options.function_units);
          })) {
        const exponents widest = exponents::widest();
        for (const std::string& text : f.constants) constants_.push_back(constant_of(text));
        std::vector<size_t> results{f.result};
        for (const auto& c : f.constraints) results.insert(results.end(), {c.left, c.right});
        live_ = nodes_of(f, {f.result});
        all_ = nodes_of(f, results);
        over_.resize(f.nodes.size());
        at_.resize(f.nodes.size());
    }
    struct box_bound {
        double most = infinity;  ///< of the error, or of the relative error
        double reached = 0;      ///< the bound at one point, not certified
        range result = range::unknown();
        size_t split = 0;
        bool empty = false;  ///< no inputs in the box satisfy the constraints
    };

    box_bound bound_over(const std::vector<range>& box, const std::vector<double>& widths,
                         bool relative) {
        box_bound b;
        b.split = widest(box, widths);
        const bool finite = forward(over_, all_, box, nullptr);
        for (const auto& c : f_.constraints)
            if (path(c.left).lower() > path(c.right).upper()) b.empty = true;
        if (b.empty || !finite) return b;
        b.result = path(f_.result);
        backward(over_);
        b.most = plain_bound();
        if (!std::isfinite(b.most)) return b;
        std::vector<range> corner(box.begin(), box.end());
        for (range& x : corner) x = x.middle();
        double moved = 0;
        const bool has_slopes = smooth_ && slopes_of_bound();
        if (has_slopes) {
            double largest = 0;
            for (size_t k = 0; k < box.size(); ++k) {
                const range g = slope_of_input(k);
                if (g.lower() >= 0)
                    corner[k] = box[k].upper();
                else if (g.upper() <= 0)
                    corner[k] = box[k].lower();
                if (!corner[k].is_point() || g.lower() >= 0 || g.upper() <= 0) continue;
                const double part = g.most() * (box[k] - corner[k]).most();
                moved += part + doubles_underflow;
                if (part > largest) largest = part, b.split = k;
            }
            if (largest * 4 < b.most * f_.options.gap) b.split = widest(box, widths);
        }
        if (!forward(at_, all_, corner, &over_)) {
            if (relative) b.most = infinity;
            return b;
        }
        backward(at_);
        const double roundings = static_cast<double>(box.size() + 4);
        if (has_slopes)
            b.most = std::min(b.most, (bound_at_corner() + moved) * (1 + roundings * 0x1p-52));
        const bool in_box = std::ranges::all_of(f_.constraints, [&](const auto& c) {
            return at_[c.left].path.upper() <= at_[c.right].path.lower();
        });
        for (const size_t i : live_)
            if (in_box) b.reached += at_[i].error * at_[i].adjoint.least();
        if (relative) make_relative(b);
        return b;
    }
    void make_relative(box_bound& b) const {
        const double size = at_[f_.result].path.least();
        b.reached = size > 0 ? b.reached / size : infinity;
        if (!(b.result.least() > 0))
            b.most = infinity;
        else if (b.most > 0)
            b.most = b.most / b.result.least() * (1 + 0x1p-50) + doubles_underflow;
    }

    /// Each operation's part of the bound over the box.
    explanation by_operation(const std::vector<range>& box, double whole) {
        explanation e{"error", "worst case", 0, whole, {}};
        if (!forward(over_, all_, box, nullptr)) return e;
        backward(over_);
        const double sum = plain_bound();
        std::map<std::pair<std::uint32_t, std::string>, double> amounts;
        for (const size_t i : live_) {
            const node_state& s = over_[i];
            const auto& n = f_.nodes[i];
            const double amount = s.error == 0 ? 0 : s.error * s.adjoint.most();
            if (amount > 0) amounts[{n.scope, name_of_node(n)}] += amount / sum * whole;
        }
        for (const auto& [where, amount] : amounts)
            e.contributions.push_back(
                {errbound::detail::all_sources::instance().scopes_of({where.first, 0}),
                 where.second, amount, 0});
        std::ranges::stable_sort(e.contributions, std::greater<>(), &contribution::amount);
        return e;
    }

    sign_type order(size_t left, size_t right) {
        std::vector<range> box;
        for (const input_range& r : f_.inputs) box.emplace_back(r.lower, r.upper);
        std::vector<size_t> all(f_.nodes.size());
        for (size_t i = 0; i < all.size(); ++i) all[i] = i;
        forward(over_, all, box, nullptr);
        const auto both = [&](size_t i) {
            const node_state& s = over_[i];
            return hull(s.path, s.computed);
        };
        const range a = both(left), b = both(right);
        if (a.upper() < b.lower()) return sign_type::negative;
        if (a.lower() > b.upper()) return sign_type::positive;
        if (!a.is_finite() || !b.is_finite()) return sign_type::uncertain;
        if (left == right || (a.is_point() && b.is_point())) return sign_type::zero;
        return sign_type::uncertain;
    }

  private:
    const range& path(size_t i) const { return over_[i].path; }

    node_state constant_of(const std::string& text) const {
        mpfr_number precise(512), low(53), high(53), number(512), distance(53);
        const int off = set_constant(precise.get(), text, MPFR_RNDN);
        set_constant(low.get(), text, MPFR_RNDD);
        set_constant(high.get(), text, MPFR_RNDU);
        mpfr_set_ld(number.get(), rounded_to(precise.get(), format_.digits, format_.min_exponent),
                    MPFR_RNDN);
        mpfr_sub(distance.get(), number.get(), precise.get(), MPFR_RNDA);
        node_state c;
        c.computed = {mpfr_get_d(number.get(), MPFR_RNDD), mpfr_get_d(number.get(), MPFR_RNDU)};
        c.path =
            hull(c.computed, {mpfr_get_d(low.get(), MPFR_RNDD), mpfr_get_d(high.get(), MPFR_RNDU)});
        c.error = std::abs(mpfr_get_d(distance.get(), MPFR_RNDA));
        // The precise constant may be off by 2^-512 of its size.
        if (off != 0)
            c.error = c.error * (1 + 0x1p-50) + std::ldexp(c.path.most(), -500) + doubles_underflow;
        if (!(c.computed.most() <= format_.largest)) c.computed = range::unknown();
        c.grid = format_.grid_of(c.computed);
        if (c.computed.is_point() && c.computed.lower() != 0) {
            int e = 0;  // becomes that of the last bit
            double m = std::frexp(c.computed.lower(), &e);
            for (; m != 0; --e) m = 2 * m - std::trunc(2 * m);
            c.grid = std::max(c.grid, e);
        }
        return c;
    }

    static std::string name_of_node(const recording::node& n) {
        if (n.kind != recording::leaf::none)
            return n.kind == recording::leaf::input ? "input" : "constant";
        if (n.operation > operation_kind::divide) return std::string(name_of(n.operation));
        return {"+-*/"[static_cast<size_t>(n.operation)]};
    }

    static size_t widest(const std::vector<range>& box, const std::vector<double>& widths) {
        size_t widest = 0;
        double share = -1;
        for (size_t k = 0; k < box.size(); ++k) {
            const double s = widths[k] > 0 ? (box[k].upper() - box[k].lower()) / widths[k] : 0;
            if (s > share) share = s, widest = k;
        }
        return widest;
    }

    /// Values, errors and slopes over the inputs. Paths use `errors`, if given, instead of their
    /// own. Returns false if a live value may be infinite or undefined.
    bool forward(states& s, const std::vector<size_t>& order, const std::vector<range>& inputs,
                 const states* errors) {
        smooth_ = true;
        for (const size_t i : order) {
            node_state& to = s[i];
            const auto& n = f_.nodes[i];
            const size_t index = n.left;
            if (n.kind == recording::leaf::input)
                set_input(to, inputs[index], f_.inputs[index].error);
            else if (n.kind == recording::leaf::constant)
                to = constants_[index];
            else
                set_operation(to, n, s);
            const double e = errors == nullptr ? to.error : (*errors)[i].error;
            if (n.kind != recording::leaf::constant && e != 0) to.path += range(-e, e);
        }
        return std::ranges::all_of(live_, [&](size_t i) {
            const node_state& x = s[i];
            return x.path.is_finite() && x.computed.is_finite();
        });
    }
    void set_input(node_state& to, const range& x, double error) const {
        to.path = to.computed = x;
        to.error = error;
        if (f_.options.round_inputs) {
            to.error = (error + format_.half_ulp(x.most() + error)) * (1 + 0x1p-50);
            if (error == 0 && format_.digits <= 53) {
                to.error = format_.half_ulp(x.most());
                to.computed = {format_.nearest(x.lower()), format_.nearest(x.upper())};
            }
        }
        if (to.error != 0 && (error != 0 || format_.digits > 53))
            to.computed += range(-to.error, to.error);
        if (!(to.computed.most() <= format_.largest)) to.computed = range::unknown();
        to.grid = format_.grid_of(to.computed);
    }
    void set_operation(node_state& to, const recording::node& n, const states& s) {
        const node_state &a = s[n.left], &b = s[n.right], &c = s[n.third];
        const range &x = a.computed, &y = b.computed;
        const bool once = n.left == n.right;
        int grid = -(1 << 20);
        set_path(to, n, a.path, b.path, c.path);
        if (set_exact(to, n, a, b)) return;
        switch (n.operation) {
            case operation_kind::add:
            case operation_kind::subtract: {
                const bool adds = n.operation == operation_kind::add;
                set_rounded(to, adds ? x + y : x - y, x, adds ? y : -y, false, std::plus<>());
                // x is a number of the format too, at a distance of |y|.
                to.error = std::min({to.error, x.most(), y.most()});
                if (near(x, adds ? -y : y)) to.error = 0;
                grid = std::min(a.grid, b.grid);
                break;
            }
            case operation_kind::multiply:
                set_rounded(to, once ? square(x) : x * y, x, y, once, std::multiplies<>());
                grid = a.grid + b.grid;
                if (is_scaling(x) || is_scaling(y))
                    to.error = (is_scaling(x) ? x : y).most() >= 1 ? 0 : half_underflow();
                break;
            case operation_kind::divide:
                set_rounded(to, x / y, x, y, false, std::divides<>());
                if (is_scaling(y)) {
                    to.error = y.most() <= 1 ? 0 : half_underflow();
                    grid = a.grid - std::ilogb(y.most());
                }
                break;
            case operation_kind::root:
                set_rounded(to, sqrt(x), x, x, true, [](const auto& z, const auto&) {
                    using std::sqrt;
                    return sqrt(z);
                });
                break;
            case operation_kind::fused:
                set_rounded(to, x * y + c.computed);
                grid = std::min(a.grid + b.grid, c.grid);
                break;
            default:
                set_function(to, function_of(n.operation), x, y);
        }
        // Errors are multiples of 2^grid, as operands and results are.
        if (to.error < std::ldexp(1.0, grid)) to.error = 0;
        if (!(to.computed.most() <= format_.largest)) to.computed = range::unknown();
        to.grid = std::max(format_.grid_of(to.computed), grid);
    }
    double half_underflow() const { return format_.half_ulp(doubles_underflow); }
    void set_function(node_state& to, elementary_function f, const range& x, const range& y) const {
        const range r = function_value(f, x, y);
        // function_error does not cover large angles.
        const bool covered = r.is_finite() && !(errbound::detail::is_function_of_angle(f) &&
                                                x.most() >= errbound::detail::least_reduced_angle);
        to.error = covered ? format_.function_error_of(f, r.most()) : infinity;
        to.computed = std::isfinite(to.error) ? r + range(-to.error, to.error) : range::unknown();
    }
    /// Returns false unless the operation never rounds.
    static bool set_exact(node_state& to, const recording::node& n, const node_state& a,
                          const node_state& b) {
        to.error = 0;
        to.grid = std::min(a.grid, b.grid);
        if (n.operation == operation_kind::lesser)
            to.computed = min(a.computed, b.computed);
        else if (n.operation == operation_kind::greater)
            to.computed = max(a.computed, b.computed);
        else if (n.operation == operation_kind::subtract && n.left == n.right)
            to.computed = 0;
        else if (n.operation == operation_kind::negate || n.operation == operation_kind::absolute) {
            to.grid = a.grid;
            to.computed = n.operation == operation_kind::negate ? -a.computed : abs(a.computed);
        } else
            return false;
        return true;
    }
    /// Sterbenz: the difference of x and y is exact.
    static bool near(const range& x, const range& y) {
        const auto ordered = [](const range& p, const range& q) {
            return p.lower() > 0 && q.lower() > 0 && p.upper() / 2 <= q.lower() &&
                   q.upper() / 2 <= p.lower();
        };
        return ordered(x, y) || ordered(-x, -y);
    }
    static bool is_scaling(const range& x) { return x.is_point() && is_power_of_two(x.lower()); }

    /// The rounded f of two operands, monotone in each; of one if `once`. `exact` encloses it. For
    /// doubles, the ends of computed values are rounded ends. A largest one that is a power of two
    /// may have been rounded down to it.
    template <class Operation>
    void set_rounded(node_state& to, const range& exact, const range& x, const range& y, bool once,
                     const Operation& f) {
        if (!format_.is_double() || !exact.is_finite()) return set_rounded(to, exact);
        const range p = once ? range(x.least(), x.most()) : x, q = once ? p : y;
        double low = infinity, high = -infinity, most = 0;
        const auto corner = [&](double u, double v) {
            low = std::min(low, f(u, v));
            high = std::max(high, f(u, v));
        };
        const auto corners = [&](const auto& visit) {
            visit(p.lower(), q.lower());
            visit(p.upper(), q.upper());
            if (once) return;
            visit(p.lower(), q.upper());
            visit(p.upper(), q.lower());
        };
        corners(corner);
        to.computed = {low, high};
        most = to.computed.most();
        if (is_power_of_two(most))
            corners(
                [&](double u, double v) { most = std::max(most, f(range(u), range(v)).most()); });
        to.error = format_.half_ulp(most > 0 ? most : exact.most());  // all may underflow to 0
    }
    void set_rounded(node_state& to, const range& r) {
        to.error = format_.half_ulp(r.most());
        if (!r.is_finite())
            to.computed = range::unknown();
        else if (format_.digits <= std::numeric_limits<double>::digits)
            to.computed = {format_.nearest(r.lower()), format_.nearest(r.upper())};
        else
            to.computed = r + range(-to.error, to.error);
    }
    static range function_value(elementary_function f, const range& a, const range& b) {
        return with_function(f, [&]<elementary_function F>() {
            if constexpr (F == elementary_function::pow)
                return power_over(a, b);
            else if constexpr (F == elementary_function::atan2)
                return angle_over(a, b);
            else
                return function_over<F>(a);
        });
    }
    static range angle_over(const range& y, const range& x) {
        // The angle jumps at the negative x axis.
        if (!y.is_finite() || !x.is_finite() || (y.has_zero() && !(x.lower() > 0)))
            return range::unknown();
        if constexpr (function_error<elementary_function::atan2, double> != 0) {
            const double m = y.middle(), n = x.middle();
            const auto r =
                errbound::detail::angle_of_ranges<double>(m, (y - m).most(), n, (x - n).most());
            if (std::isfinite(r.error)) return range::within(r.value, r.error);
        }
        return range::unknown();
    }

    /// The exact operation on paths, with its derivatives.
    void set_path(node_state& to, const recording::node& n, const range& a, const range& b,
                  const range& c) {
        to.curvature_left = to.curvature_both = to.curvature_right = 0;
        const auto set = [&](const range& path, const range& left, const range& right = 0,
                             const range& third = 0) {
            to.path = path;
            to.slopes = {left, right, third};
        };
        const auto chosen = [&](const range& path, bool left, bool right) {
            const range none(0), one(1), some(0, 1);
            set(path, left ? one : right ? none : some, left ? none : right ? one : some);
            smooth_ &= left || right;
        };
        const bool once = n.left == n.right;
        switch (n.operation) {
            case operation_kind::add:
                return set(a + b, 1, 1);
            case operation_kind::subtract:
                return set(once ? 0 : a - b, 1, -1);
            case operation_kind::multiply:
            case operation_kind::fused: {
                const bool adds = n.operation == operation_kind::fused;
                const range product = once ? square(a) : a * b;
                to.curvature_both = 1;
                return set(adds ? product + c : product, b, a, adds ? 1 : 0);
            }
            case operation_kind::divide: {
                const range r = 1 / b, q = once && !b.has_zero() ? 1 : a / b;
                to.curvature_both = -square(r);
                to.curvature_right = 2 * q * square(r);
                return set(q, r, -q * r);
            }
            case operation_kind::negate:
                return set(-a, -1);
            case operation_kind::root: {
                const range root = sqrt(a), slope = 1 / (2 * root);
                to.curvature_left = -slope / (2 * a);
                return set(root, slope);
            }
            case operation_kind::absolute:
                smooth_ &= a.lower() >= 0 || a.upper() <= 0;
                return set(abs(a), {a.lower() >= 0 ? 1.0 : -1.0, a.upper() <= 0 ? -1.0 : 1.0});
            case operation_kind::lesser:
                return chosen(min(a, b), a.upper() <= b.lower(), b.upper() <= a.lower());
            case operation_kind::greater:
                return chosen(max(a, b), a.lower() >= b.upper(), b.lower() >= a.upper());
            default:
                set_function_path(to, function_of(n.operation), a, b);
        }
    }
    void set_function_path(node_state& to, elementary_function f, const range& a, const range& b) {
        if (f == elementary_function::pow) {
            to.path = power_over(a, b);
            to.slopes = {b * power_over(a, b - 1), 0, 0};
            if (!b.is_point()) {
                to.slopes[1] = to.path * function_over<elementary_function::log>(a);
                smooth_ = false;
            }
            to.curvature_left = b * (b - 1) * power_over(a, b - 2);
        } else if (f == elementary_function::atan2) {
            const range s = square(a) + square(b), both = 2 * a * b / square(s);
            to.path = angle_over(a, b);
            to.slopes = {b / s, -a / s, 0};
            to.curvature_left = -both;
            to.curvature_right = both;
            to.curvature_both = (square(a) - square(b)) / square(s);
        } else {
            with_function(f, [&]<elementary_function F>() {
                if constexpr (!has_two_arguments(F)) {
                    const function_range r = derivatives_over<F>(a);
                    to.path = r.value;
                    to.slopes = {r.slope, 0, 0};
                    to.curvature_left = r.curvature;
                }
            });
        }
    }

    template <class Visit>
    static void for_operands(const recording::node& n, const Visit& visit) {
        if (n.kind != recording::leaf::none) return;
        const expression_operation o{n.operation};
        visit(0, n.left);
        if (o.has_right()) visit(1, n.right);
        if (o.has_third()) visit(2, n.third);
    }
    /// The derivatives of the result by each value.
    void backward(states& s) const {
        for (const size_t i : live_) s[i].adjoint = 0;
        s[f_.result].adjoint = 1;
        for (auto i = live_.rbegin(); i != live_.rend(); ++i) {
            const node_state& from = s[*i];
            for_operands(f_.nodes[*i], [&](size_t o, size_t j) {
                s[j].adjoint += from.adjoint * from.slopes[o];
            });
        }
    }
    /// Σ ε_i max |A_i|, rounded up: each of the additions and products loses at most 2^-53 of it.
    double plain_bound() const {
        double sum = 0;
        for (const size_t i : live_) {
            const node_state& x = over_[i];
            if (x.error != 0) sum += x.error * x.adjoint.most() + doubles_underflow;
        }
        return sum * (1 + static_cast<double>(live_.size() + 4) * 0x1p-52);
    }
    /// 1 or −1 if A_i has this sign over the box; otherwise 0.
    static double sign_of_adjoint(const node_state& x) {
        return x.adjoint.lower() >= 0 ? 1 : x.adjoint.upper() <= 0 ? -1 : 0;
    }
    /// Differentiates S = Σ ±ε_i A_i, over values with an A_i of one sign. S is the result's
    /// tangent if each value has the additional tangent ±ε_i. Returns false if a derivative is
    /// unbounded.
    bool slopes_of_bound() {
        for (const size_t i : live_) {
            node_state& x = over_[i];
            x.tangent = sign_of_adjoint(x) * x.error;
            x.pull = 0;
            for_operands(f_.nodes[i],
                         [&](size_t o, size_t j) { x.tangent += over_[j].tangent * x.slopes[o]; });
        }
        for (auto i = live_.rbegin(); i != live_.rend(); ++i) {
            const node_state& x = over_[*i];
            const auto& n = f_.nodes[*i];
            const size_t left = n.left, right = n.right;
            for_operands(n, [&](size_t o, size_t j) {
                range change = o == 2   ? range(0)
                               : o == 0 ? x.curvature_left * over_[left].tangent
                                        : x.curvature_both * over_[left].tangent +
                                              x.curvature_right * over_[right].tangent;
                if (o == 0 && expression_operation{n.operation}.has_right())
                    change += x.curvature_both * over_[right].tangent;
                over_[j].pull += x.pull * x.slopes[o] + x.adjoint * change;
            });
        }
        return std::ranges::all_of(live_, [&](size_t i) {
            return f_.nodes[i].kind != recording::leaf::input || over_[i].pull.is_finite();
        });
    }
    range slope_of_input(size_t k) const {
        const auto is_input = [&](size_t i) {
            const auto& n = f_.nodes[i];
            return n.kind == recording::leaf::input && n.left == k;
        };
        const auto found = std::ranges::find_if(live_, is_input);
        return found == live_.end() ? range(0) : over_[*found].pull;
    }
    /// S at the corner, and ε_i max |A_i| for values with an A_i of both signs.
    double bound_at_corner() const {
        range sum = 0;
        for (const size_t i : live_) {
            const node_state &x = over_[i], &y = at_[i];
            if (x.error == 0) continue;
            const double sign = sign_of_adjoint(x);
            sum += sign == 0 ? range(x.error) * x.adjoint.most() : sign * x.error * y.adjoint;
        }
        return sum.upper();
    }

    const recording& f_;
    number_format format_;
    std::vector<node_state> constants_;
    std::vector<size_t> live_, all_;
    states over_, at_;
    bool smooth_ = true;
};

class branch_and_bound {
  public:
    branch_and_bound(const recording& f, analysis& a, bool relative)
        : f_(f), analysis_(a), relative_(relative) {
        for (const input_range& r : f.inputs) {
            whole_.emplace_back(r.lower, r.upper);
            widths_.push_back(r.upper - r.lower);
        }
    }

    struct box {
        std::vector<range> inputs;
        double most = infinity, reached = 0;
        size_t split = 0;
        range result = range::unknown();
    };

    void run() {
        const auto start = std::chrono::steady_clock::now();
        const auto seconds = [&] {
            return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        };
        add({whole_});
        while (!open_.empty()) {
            const double most = open_.front().most;
            if (most <= std::max(reached_ * (1 + f_.options.gap), done_)) break;
            const bool stalls = boxes_ >= next_check_ && most > (1 - f_.options.gap / 4) * before_;
            if (boxes_ >= next_check_) next_check_ = boxes_ + 20'000, before_ = most;
            if (stalls || boxes_ >= f_.options.boxes || seconds() > f_.options.seconds ||
                (relative_ && reached_ == infinity)) {
                complete_ = false;
                break;
            }
            std::ranges::pop_heap(open_, {}, &box::most);
            box b = std::move(open_.back());
            open_.pop_back();
            const size_t k = b.split;
            const double low = b.inputs.empty() ? 0 : b.inputs[k].lower(),
                         high = b.inputs.empty() ? 0 : b.inputs[k].upper(),
                         middle = middle_of(low, high);
            if (!(low < middle && middle < high)) {
                done_ = std::max(done_, b.most);  // cannot be split
                done_result_ = done_result_ ? hull(*done_result_, b.result) : b.result;
                if (b.most >= worst_.most || worst_.inputs.empty()) worst_ = std::move(b);
                continue;
            }
            for (const range& half : {range(low, middle), range(middle, high)}) {
                box child{b.inputs, b.most, 0, 0, b.result};
                child.inputs[k] = half;
                add(std::move(child));
            }
        }
    }
    double most() const { return open_.empty() ? done_ : std::max(done_, open_.front().most); }
    const box& worst() const {
        return open_.empty() || open_.front().most < done_ ? worst_ : open_.front();
    }
    /// Encloses the exact results; nothing without inputs that satisfy the constraints.
    std::optional<range> result() const {
        std::optional<range> all = done_result_;
        for (const box& b : open_) all = all ? hull(*all, b.result) : b.result;
        return all;
    }
    size_t boxes() const { return boxes_; }
    bool complete() const { return complete_; }
    /// Boxes where the error may be large.
    std::vector<std::vector<input_range>> hot() const {
        std::vector<std::vector<input_range>> all;
        const auto put = [&](const box& b) {
            std::vector<input_range> one;
            for (const range& r : b.inputs) one.push_back({r.lower(), r.upper()});
            all.push_back(std::move(one));
        };
        for (const box& b : best_) put(b);
        for (size_t i = 0; i < std::min<size_t>(open_.size(), 16); ++i) put(open_[i]);
        if (all.empty()) all.push_back(f_.inputs);
        return all;
    }

  private:
    /// The geometric mean of numbers of one sign that differ much in size.
    static double middle_of(double low, double high) {
        if (low > 0 && high > 16 * low) return std::sqrt(low) * std::sqrt(high);
        if (high < 0 && low < 16 * high) return -std::sqrt(-low) * std::sqrt(-high);
        return low / 2 + high / 2;
    }
    void add(box b) {
        ++boxes_;
        const analysis::box_bound found = analysis_.bound_over(b.inputs, widths_, relative_);
        if (found.empty) return;
        b.result = common(b.result, found.result);
        b.most = std::min(b.most, found.most);
        b.reached = found.reached;
        b.split = found.split;
        if (b.reached > reached_ || best_.size() < 16) {
            best_.push_back(b);
            std::ranges::stable_sort(best_, std::greater<>(), &box::reached);
            if (best_.size() > 16) best_.pop_back();
        }
        reached_ = std::max(reached_, b.reached);
        open_.push_back(std::move(b));
        std::ranges::push_heap(open_, {}, &box::most);
    }

    const recording& f_;
    analysis& analysis_;
    bool relative_;
    std::vector<range> whole_;
    std::vector<double> widths_;
    std::vector<box> open_, best_;  ///< a heap by `most`
    box worst_;
    std::optional<range> done_result_;
    double reached_ = 0, done_ = 0;
    size_t boxes_ = 0, next_check_ = 20'000;
    double before_ = infinity;  ///< the bound at the last check for progress
    bool complete_ = true;
};

}  // namespace

recording::recording(number_type format, std::vector<input_range> box,
                     const worst_case_options& limits)
    : type(format), inputs(std::move(box)), options(limits), outer_(current()) {
    for (size_t k = 0; k < inputs.size(); ++k) {
        const input_range& r = inputs[k];
        if (!(r.lower <= r.upper) || !std::isfinite(r.lower) || !std::isfinite(r.upper) ||
            !(r.error >= 0) || !std::isfinite(r.error))
            throw std::invalid_argument("range of input " + std::to_string(k) + " is [" +
                                        std::to_string(r.lower) + ", " + std::to_string(r.upper) +
                                        "] with error " + std::to_string(r.error) +
                                        "; expected finite numbers, lower <= upper, error >= 0");
    }
    current() = this;
}

size_t recording::constant(const std::string& text) {
    mpfr_number checked(53);
    set_constant(checked.get(), text, MPFR_RNDN);
    const auto found = std::ranges::find(constants, text);
    const auto index = static_cast<size_t>(found - constants.begin());
    if (found == constants.end()) constants.push_back(text);
    return add({.kind = leaf::constant, .left = index});
}

sign_type recording::order(size_t left, size_t right) const {
    const sign_type sign = analysis(*this).order(left, right);
    if (certain(sign)) return sign;
    throw undecided_comparison("the result of a comparison depends on the input");
}

worst_case_result worst_case_of(const recording& f) {
    const auto start = std::chrono::steady_clock::now();
    analysis a(f);
    branch_and_bound bound(f, a, false);
    bound.run();
    worst_case_result r;
    r.at_most = bound.most();
    r.boxes = bound.boxes();
    r.complete = bound.complete();
    if (const std::optional<range> result = bound.result()) {
        r.lower = result->lower();
        r.upper = result->upper();
    }
    if (!bound.worst().inputs.empty() || f.inputs.empty())
        r.by_operation = a.by_operation(bound.worst().inputs, r.at_most);
    if (f.options.samples > 0) {
        observed_error found = largest_error(f, bound.hot());
        r.at_least = found.at_least;
        r.where = std::move(found.where);
    }
    r.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (f.options.relative) {
        branch_and_bound relative(f, a, true);
        relative.run();
        r.relative_at_most = relative.most();
    }
    return r;
}

}  // namespace errbound::validation
