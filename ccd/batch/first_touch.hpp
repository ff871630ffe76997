// Memory whose pages are first written by the threads that fill them. The system clears a page at
// the first write, which takes a large share of a step's time.
#pragma once

#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace ccd::detail {

template <class T>
struct first_touch_allocator : std::allocator<T> {
    static_assert(std::is_trivially_copyable_v<T>);
    template <class U>
    struct rebind {
        using other = first_touch_allocator<U>;
    };

    void construct(T*) {}
    template <class... Values>
    void construct(T* place, Values&&... values) {
        std::construct_at(place, std::forward<Values>(values)...);
    }
};

/// A vector whose resize() leaves new elements uninitialised.
template <class T>
using first_touch_vector = std::vector<T, first_touch_allocator<T>>;

}  // namespace ccd::detail
