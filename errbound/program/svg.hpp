// Text of SVG pictures. Internal.
#pragma once

#include <errbound/explain/explanation.hpp>
#include <string>
#include <string_view>

namespace errbound::explaining {

/// Precondition: UTF-8 without control characters. Two other characters that XML forbids become
/// '?'.
inline std::string escaped(std::string_view text) {
    std::string result;
    for (; !text.empty(); text.remove_prefix(detail::character_length(text))) {
        const std::string_view character = text.substr(0, detail::character_length(text));
        if (character == "<")
            result += "&lt;";
        else if (character == ">")
            result += "&gt;";
        else if (character == "&")
            result += "&amp;";
        else if (character == "\"")
            result += "&quot;";
        else if (character == "\xef\xbf\xbe" || character == "\xef\xbf\xbf")
            result += '?';
        else
            result += character;
    }
    return result;
}

/// A picture on a white ground, in monospace of 12 pixels.
inline std::string svg_of(double width, double height, const std::string& body) {
    const std::string w = detail::tenths(width), h = detail::tenths(height);
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + w + "\" height=\"" + h +
           "\" viewBox=\"0 0 " + w + ' ' + h +
           "\" font-family=\"monospace\" font-size=\"12\">\n"
           "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" +
           body + "</svg>\n";
}

}  // namespace errbound::explaining
