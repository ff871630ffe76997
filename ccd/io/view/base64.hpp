// Arrays as text: base64.
#pragma once

#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <string>
#include <string_view>

namespace ccd::io::detail {

/// Appends bytes in base64, padded.
inline void append_base64(std::string& text, std::string bytes) {
    using namespace boost::archive::iterators;
    using digits = base64_from_binary<transform_width<std::string::const_iterator, 6, 8>>;
    const std::size_t padding = (3 - bytes.size() % 3) % 3;
    bytes.append(padding, '\0');
    text.reserve(text.size() + bytes.size() / 3 * 4);
    text.append(digits(bytes.cbegin()), digits(bytes.cend()));
    text.replace(text.size() - padding, padding, padding, '=');
}

/// The bytes of numbers, or of arrays of them, in this machine's order.
template <class Items>
std::string_view bytes_of(const Items& items) {
    return {reinterpret_cast<const char*>(items.data()), items.size() * sizeof(*items.data())};
}

}  // namespace ccd::io::detail
