#include "tests/everywhere/recorder.hpp"

#include <cinttypes>
#include <cstdio>

namespace everywhere {

void recorder::add(const ccd::first_contact& c) {
    add(c.time);
    add(c.features.kind);
    for (const auto p : c.features.points) add(p);
    for (const double w : c.weights) add(w);
    add(c.weight_error);
    add(c.normal);
    add(c.normal_error);
    add(c.normal_from);
    add(c.sided);
    add(c.normal_velocity);
    add(c.normal_velocity_error);
}

void recorder::end_item(const std::string& name) {
    if (prints_items_) std::printf("%016" PRIx64 " %s\n", hash_, name.c_str());
}

}  // namespace everywhere
