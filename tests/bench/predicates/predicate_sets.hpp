// The predicates' plain expressions and the sets of inputs, shared by the benchmarks of predicates.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <errbound/predicate_batch.hpp>
#include <errbound/predicates.hpp>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/errbound/predicates/predicate_inputs.hpp"

namespace bench {

using predicate_inputs::surface;
namespace forms = errbound::forms;

/// A predicate next to its expression, for points of any number type.
struct orient2d_form {
    static constexpr std::string_view name = "orient2d";
    static constexpr std::size_t dimension = 2, count = 3;
    static constexpr surface degenerate = surface::flat;
    static constexpr const auto& predicate = errbound::orient2d;
    auto operator()(const auto& a, const auto& b, const auto& c) const {
        return forms::area(a, b, c);
    }
};
struct orient3d_form {
    static constexpr std::string_view name = "orient3d";
    static constexpr std::size_t dimension = 3, count = 4;
    static constexpr surface degenerate = surface::flat;
    static constexpr const auto& predicate = errbound::orient3d;
    auto operator()(const auto& a, const auto& b, const auto& c, const auto& d) const {
        return forms::volume(a, b, c, d);
    }
};
struct incircle_form {
    static constexpr std::string_view name = "incircle";
    static constexpr std::size_t dimension = 2, count = 4;
    static constexpr surface degenerate = surface::round;
    static constexpr const auto& predicate = errbound::incircle;
    auto operator()(const auto& a, const auto& b, const auto& c, const auto& d) const {
        return forms::lifted_area(a, b, c, d, forms::unweighted);
    }
};
struct insphere_form {
    static constexpr std::string_view name = "insphere";
    static constexpr std::size_t dimension = 3, count = 5;
    static constexpr surface degenerate = surface::round;
    static constexpr const auto& predicate = errbound::insphere;
    auto operator()(const auto& a, const auto& b, const auto& c, const auto& d,
                    const auto& e) const {
        return forms::lifted_volume(a, b, c, d, e, forms::unweighted);
    }
};
inline constexpr std::tuple<orient2d_form, orient3d_form, incircle_form, insphere_form> all_forms;

/// Inputs stored as ranges of points, one range for each argument.
template <std::size_t D, std::size_t N>
struct input_set {
    std::array<std::vector<std::array<double, D>>, N> points;
    std::array<std::array<std::vector<double>, D>, N> arrays;

    template <class Make>
    input_set(const Make& make, surface s, std::size_t count, int scale) {
        predicate_inputs::generator random(3);
        for (std::size_t i = 0; i < count; ++i) {
            const auto p = make(random, s);
            for (std::size_t k = 0; k < N; ++k) {
                points[k].emplace_back();
                for (std::size_t d = 0; d < D; ++d) {
                    points[k].back()[d] = std::ldexp(p[k][d], scale);
                    arrays[k][d].push_back(points[k].back()[d]);
                }
            }
        }
    }
    std::size_t size() const { return points[0].size(); }
    errbound::coordinate_arrays<double, D> as_arrays(std::size_t argument) const {
        errbound::coordinate_arrays<double, D> a{{}, size()};
        for (std::size_t d = 0; d < D; ++d) a.coordinates[d] = arrays[argument][d].data();
        return a;
    }
    template <class Call>
    auto with(std::size_t i, const Call& call) const {
        return [&]<std::size_t... K>(std::index_sequence<K...>) {
            return call(points[K][i]...);
        }
        (std::make_index_sequence<N>());
    }
};
template <class Form>
using set_of = input_set<Form::dimension, Form::count>;

using signs = std::vector<errbound::sign_type>;

template <class Number>
errbound::sign_type plain_sign(const Number& x) {
    return static_cast<errbound::sign_type>((x > 0) - (x < 0) + 1);
}

struct input_kind {
    std::string_view name;
    std::size_t family;
    int scale;
};
inline constexpr int far = 531;  // 1e160
inline constexpr std::array<input_kind, 6> input_kinds{{{"uniform", 0, 0},
                                                        {"near", 1, 0},
                                                        {"grid", 2, 0},
                                                        {"deep", 3, 0},
                                                        {"near, at 1e-160", 1, -far},
                                                        {"near, at 1e+160", 1, far}}};
template <class Form>
set_of<Form> make_set(const input_kind& kind, std::size_t inputs) {
    return {predicate_inputs::families<double, Form::dimension, Form::count>[kind.family].make,
            Form::degenerate, inputs, kind.scale};
}

}  // namespace bench
