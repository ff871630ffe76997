// Conversion between NumPy's arrays and spans or vectors.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace errbound::python {

namespace nb = nanobind;

/// An argument, which is not copied. errbound/_arrays.py makes it contiguous.
template <class T, nb::ssize_t... Shape>
using input = nb::ndarray<const T, nb::shape<Shape...>, nb::c_contig, nb::device::cpu>;

template <class Item, class Array>
std::span<const Item> items_of(const Array& array) {
    static_assert(sizeof(Item) % sizeof(*array.data()) == 0);
    return {reinterpret_cast<const Item*>(array.data()),
            array.size() * sizeof(*array.data()) / sizeof(Item)};
}

/// A vector that lives as long as the arrays that refer to it.
template <class Item>
class shared_items {
  public:
    explicit shared_items(std::vector<Item>&& items)
        : items_(new std::vector<Item>(std::move(items))),
          owner_(items_, [](void* p) noexcept { delete static_cast<std::vector<Item>*>(p); }) {}

    template <class Number>
    nb::object column(const Number& of_first) const {
        return view(&of_first, {items_->size()}, {stride<Number>()});
    }
    /// Returns `count` adjacent numbers of each item.
    template <class Number>
    nb::object columns(const Number* of_first, std::size_t count) const {
        return view(of_first, {items_->size(), count}, {stride<Number>(), 1});
    }
    /// Returns the first item, or a default one, whose members select columns.
    const Item& first() const {
        static const Item none{};
        return items_->empty() ? none : items_->front();
    }

  private:
    template <class Number>
    static constexpr std::int64_t stride() {
        static_assert(sizeof(Item) % sizeof(Number) == 0);
        return sizeof(Item) / sizeof(Number);
    }
    template <class Number>
    nb::object view(const Number* data, std::initializer_list<std::size_t> shape,
                    std::initializer_list<std::int64_t> strides) const {
        return nb::cast(
            nb::ndarray<nb::numpy, Number>(const_cast<Number*>(data), shape, owner_, strides));
    }

    std::vector<Item>* items_;
    nb::capsule owner_;
};

template <class Number, class Item>
nb::object rows_of(std::vector<Item>&& items) {
    static_assert(sizeof(Item) % sizeof(Number) == 0);
    const shared_items<Item> shared(std::move(items));
    return shared.columns(reinterpret_cast<const Number*>(&shared.first()),
                          sizeof(Item) / sizeof(Number));
}
template <class Number, class Item>
nb::object numbers_of(std::vector<Item>&& items) {
    static_assert(sizeof(Item) == sizeof(Number));
    const shared_items<Item> shared(std::move(items));
    return shared.column(reinterpret_cast<const Number&>(shared.first()));
}

}  // namespace errbound::python
