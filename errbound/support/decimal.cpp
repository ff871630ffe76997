// Uses the C++ library, or fast_float if that library cannot convert floating point (libc++ before
// 20).
#include "errbound/support/decimal.hpp"

#include <charconv>
#include <cmath>
#include <locale>
#include <sstream>
#include <string>
#include <system_error>

#ifdef __cpp_lib_to_chars
using std::from_chars;
#else
#include <fast_float/fast_float.h>
using fast_float::from_chars;
#endif

namespace errbound::support {

template <class T>
decimal<T> parse_decimal(std::string_view text) {
    T value = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, ec] = from_chars(text.data(), end, value);
    if (ec == std::errc::invalid_argument || rest != end) return {0, decimal_status::malformed};
    if (ec == std::errc::result_out_of_range) {
        // The number is too large or too small. If it is too small, the stream gives the nearest
        // value; libc++ also fails.
        std::istringstream stream{std::string(text)};
        stream.imbue(std::locale::classic());
        stream.exceptions(std::ios::badbit);  // running out of memory is no overflow
        if (!(stream >> value) && std::abs(value) >= 1) return {0, decimal_status::overflow};
    }
    // fast_float 3.9 silently returns infinity.
    const bool has_digits = text.find_first_of("0123456789") != std::string_view::npos;
    if (std::isinf(value) && has_digits) return {0, decimal_status::overflow};
    return {value, decimal_status::ok};
}
template decimal<float> parse_decimal(std::string_view);
template decimal<double> parse_decimal(std::string_view);

}  // namespace errbound::support
