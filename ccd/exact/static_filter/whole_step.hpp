// Y and the G_i of a query over the step, with error bounds that hold for every interval of it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <errbound/roots/control_values.hpp>
#include <tuple>
#include <utility>

#include "ccd/exact/static_filter/coefficient_signs.hpp"
#include "ccd/exact/static_filter/constants.hpp"
#include "ccd/exact/static_filter/difference_extents.hpp"

namespace ccd::static_filter {

template <class S, std::size_t Constraints, int YDegree = 3, int GDegree = 4>
struct part_forms {
    errbound::roots::control_values<S, YDegree> y;
    std::array<errbound::roots::control_values<S, GDegree>, Constraints> g;
};

/// Bounds for all control values after at most max_depth halvings.
template <class S>
struct form_errors {
    S y, g;
};

template <class S, template <class> class Forms>
struct whole_step {
    static constexpr std::size_t constraints =
        std::tuple_size_v<decltype(std::declval<Forms<S>>().inside())>;

    part_forms<S, constraints> forms;
    form_errors<S> errors;

    constexpr whole_step(const Forms<S>& f, const difference_extents<S>& m) {
        using std::max;
        const S y_error = m.template error_of_y<Forms>();
        const S g_error = m.template error_of_g<Forms>();
        forms.y = errbound::roots::control_values_of(f.y());
        const auto g = f.inside();
        S largest(0.0);
        for (std::size_t i = 0; i < constraints; ++i) {
            forms.g[i] = errbound::roots::control_values_of(g[i]);
            largest = max(largest, size_of(forms.g[i]));
        }
        using real = typename real_of<S>::type;
        errors = {y_error + size_of(forms.y) * S(y_constants<Forms, real>.halvings),
                  g_error + largest * S(g_constants<Forms, real>.halvings)};
    }

    constexpr mask<S> outside() const {
        mask<S> found = below(forms.g[0], errors.g);
        for (std::size_t i = 1; i < constraints; ++i) found = found | below(forms.g[i], errors.g);
        return found;
    }
};

}  // namespace ccd::static_filter
