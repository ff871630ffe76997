// The bound over one box: let v(t) be the values if every operation i adds t times its actual error
// e_i, for t from 0 (exact) to 1 (computed). Then computed − exact = Σ e_i ∫ A_i(t) dt, with A_i(t)
// the derivative of the result by value i at v(t). So Σ ε_i max |A_i| bounds it, if ε_i bounds
// |e_i| and A_i is enclosed over the inputs and over all |e| <= ε. There is no remainder. Internal.
#pragma once

#include <algorithm>
#include <cmath>
#include <errbound/validation/ball.hpp>
#include <errbound/validation/worst_case.hpp>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "errbound/validation/worst_case/largest_error.hpp"
#include "errbound/validation/worst_case/number_format.hpp"

namespace errbound::validation {

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
    /// doubles, the computed range ends in the rounded f of the operands' ends. If the largest
    /// magnitude is a power of two, the exact value may be larger, with an ulp twice as large.
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

}  // namespace errbound::validation
