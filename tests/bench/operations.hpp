// Counts the floating-point operations of the stages of `exact` by running them on a counting
// scalar.
#pragma once

#include <ccd/batch.hpp>
#include <cstdint>
#include <errbound/roots/control_values.hpp>

#include "ccd/batch/rounded_axes.hpp"
#include "ccd/cuda/queries.hpp"
#include "ccd/exact/static_filter/whole_step.hpp"

namespace bench {

/// Sums, products, comparisons and extrema count as one each, absolute values and negations as
/// none.
template <class T>
struct counted {
    T value{};
    static inline std::uint64_t operations = 0;

    counted() = default;
    counted(T v) : value(v) {}
    friend counted operator+(counted a, counted b) { return ++operations, a.value + b.value; }
    friend counted operator-(counted a, counted b) { return ++operations, a.value - b.value; }
    friend counted operator*(counted a, counted b) { return ++operations, a.value * b.value; }
    friend counted operator-(counted a) { return -a.value; }
    friend bool operator<(counted a, counted b) { return ++operations, a.value < b.value; }
    friend bool operator>(counted a, counted b) { return ++operations, a.value > b.value; }
    friend bool operator<=(counted a, counted b) { return ++operations, a.value <= b.value; }
    friend counted abs(counted a) { return a.value < 0 ? -a.value : a.value; }
    friend counted max(counted a, counted b) { return ++operations, a.value < b.value ? b : a; }
    friend counted min(counted a, counted b) { return ++operations, b.value < a.value ? b : a; }
};

/// The operations of a stage for one candidate. They do not depend on the coordinates.
struct stage_operations {
    std::uint64_t axes_in_floats, coplanarity, inside;
};

template <class Query>
stage_operations operations_of_stages() {
    using single = counted<float>;
    using scalar = counted<double>;
    constexpr ccd::kind kind = ccd::kind_of<Query>;
    using traits = ccd::kind_traits<kind>;
    using forms_type = ccd::detail::forms_of_kind<kind>;
    const auto counted_by = [](auto& counter, const auto& run) {
        counter = 0;
        run();
        return counter;
    };
    stage_operations all{};
    all.axes_in_floats = counted_by(single::operations, [] {
        const single x[3][2][4] = {};
        (void)ccd::detail::rounded_axes::separated<typename traits::pair>(x);
    });
    const typename traits::template query<scalar> query{};
    const auto filtered = [&](const auto& test) {
        return counted_by(scalar::operations, [&] {
            const typename forms_type::template type<scalar> forms(query);
            const ccd::static_filter::difference_extents<scalar> extents(forms);
            test(forms, extents);
        });
    };
    all.coplanarity = filtered([](const auto& forms, const auto& extents) {
        const auto y = errbound::roots::control_values_of(forms.y());
        const scalar error = extents.template error_of_y<forms_type::template type>();
        (void)ccd::static_filter::above(y, error);
        (void)ccd::static_filter::below(y, error);
    });
    all.inside = filtered([](const auto& forms, const auto& extents) {
        const ccd::static_filter::whole_step<scalar, forms_type::template type> whole(forms,
                                                                                      extents);
        (void)whole.outside();
    });
    return all;
}

}  // namespace bench
