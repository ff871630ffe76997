// The families of `ccd stress`, from the groups, and those that are no group.
#include "ccd/stress/families.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "ccd/stress/family_groups.hpp"
#include "ccd/stress/family_parts.hpp"
#include "ccd/stress/generators/contacts.hpp"

namespace ccd::stress {
namespace {

using namespace generators;

/// A thin layer, as a stiff one is: relative positions on one axis, and all relative motion, are
/// 2^knob of the common motion; in contact, or missing it by a fraction of the relative motion.
points of_stiffness(source& random, kind which, double knob) {
    const auto exponent = static_cast<int>(knob);
    std::array<position, 4> at = positions(random);
    for (position& p : at) p[2] = std::ldexp(p[2], exponent);
    points p = contact_at(random, which, std::ldexp(1, exponent), at, any_weights);
    if (random.one_in(2)) p = shifted(random, which, p, exponent - random.between(0, 20));
    if (random.one_in(2)) {  // the layer lies across the axes
        const int a = random.between(-2, 2), b = random.between(-2, 2);
        for (auto& m : p) {
            for (ccd::point<double>* x : {&m.t0, &m.t1}) x->z += a * x->x + b * x->y;
        }
    }
    return drifting(random, p);
}

points of_not_finite(source& random, kind which, double knob) {
    std::array<bool, 24> spoilt{};
    std::fill_n(spoilt.begin(), static_cast<std::size_t>(knob), true);
    for (std::size_t i = spoilt.size() - 1; i > 0; --i) {
        std::swap(spoilt[i],
                  spoilt[static_cast<std::size_t>(random.between(0, static_cast<int>(i)))]);
    }
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr double instead[] = {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity};
    return map(near_decision(random, which),
               [&](double x, std::size_t point, std::size_t end, std::size_t axis) {
                   return spoilt[6 * point + 3 * end + axis] ? instead[random.between(0, 2)] : x;
               });
}

std::vector<family> other_families() {
    return {
        {"stiff", "Thin layers: tiny relative positions and motion beside large common motion.",
         "log2 of relative over common motion", joined(range(-50, -2, 2), {-1}), of_stiffness},
        {"not-finite",
         "Some coordinates are NaN or infinite: there is no answer.",
         "coordinates that are not finite",
         {1, 2, 4, 12, 24},
         of_not_finite,
         [](double) { return 1u; },
         false},
    };
}

}  // namespace

std::span<const family> families() {
    static const std::vector<family> all = [] {
        std::vector<family> joined;
        for (const auto group : {families_of_scale, families_of_gaps, families_of_thin_features,
                                 families_of_touches, families_of_roots, other_families}) {
            const std::vector<family> its = group();
            joined.insert(joined.end(), its.begin(), its.end());
        }
        return joined;
    }();
    return all;
}

points make(const family& f, double knob, kind which, std::uint64_t seed, std::uint64_t index) {
    source random = source_of(f.name, {static_cast<std::uint64_t>(which),
                                       std::bit_cast<std::uint64_t>(knob), seed, index});
    return f.make(random, which, knob);
}

}  // namespace ccd::stress
