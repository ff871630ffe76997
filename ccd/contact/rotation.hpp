// The rotation of a quaternion that is a polynomial in t, over any ring. Internal.
#pragma once

#include <array>

namespace ccd::detail {

/// The matrix of the rotation q/|q| times |q|², and |q|² (Euler, Rodrigues).
template <class Product>
struct weighted_rotation {
    std::array<std::array<Product, 3>, 3> matrix;
    Product weight;
};

/// q is w, x, y, z.
template <class Number>
constexpr auto rotation_of(const std::array<Number, 4>& q) {
    const auto& [w, x, y, z] = q;
    const auto ww = w * w, xx = x * x, yy = y * y, zz = z * z;
    const auto twice = [](const auto& e) { return e + e; };
    const auto xy = x * y, wz = w * z, xz = x * z, wy = w * y, yz = y * z, wx = w * x;
    return weighted_rotation<decltype(w * w)>{
        {{{ww + xx - yy - zz, twice(xy - wz), twice(xz + wy)},
          {twice(xy + wz), ww - xx + yy - zz, twice(yz - wx)},
          {twice(xz - wy), twice(yz + wx), ww - xx - yy + zz}}},
        ww + xx + yy + zz};
}

}  // namespace ccd::detail
