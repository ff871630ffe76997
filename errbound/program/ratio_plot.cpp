#include "errbound/program/ratio_plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "errbound/program/svg.hpp"

namespace errbound::explaining {
namespace {

constexpr int most_decades = 4;  // larger ratios are at the right end
constexpr double names_width = 300, plot_width = 640, margin = 20, line_height = 18;
// Distinguishable by colour-blind people (Paul Tol's palettes).
constexpr std::string_view colours[] = {"#4477aa", "#ee6677", "#228833", "#ccbb44", "#66ccee",
                                        "#aa3377", "#bbbbbb", "#000000", "#ee7733", "#009988",
                                        "#882255", "#999933", "#332288", "#ddcc77"};

std::string number(double x) {
    return detail::tenths(x);
}
std::string text(double x, double y, std::string_view what, std::string_view more = "") {
    return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" " + std::string(more) + '>' +
           escaped(detail::printable(std::string(what))) + "</text>\n";
}
std::string mark(double x, double y, std::size_t series, const std::string& tip) {
    return "<circle cx=\"" + number(x) + "\" cy=\"" + number(y) + "\" r=\"4.5\" fill=\"" +
           std::string(colours[series % std::size(colours)]) + "\" fill-opacity=\"0.8\"><title>" +
           escaped(detail::printable(tip)) + "</title></circle>\n";
}

}  // namespace

std::string ratio_plot(const std::string& axis, const std::vector<std::string>& series,
                       const std::vector<ratio_line>& lines) {
    int low = 0, high = 1;
    const auto is_drawn = [](double ratio) { return ratio > 0 && std::isfinite(ratio); };
    for (const auto& [name, ratios] : lines)
        for (const double ratio : ratios)
            if (is_drawn(ratio)) {
                low = std::min(low, static_cast<int>(std::floor(std::log10(ratio))));
                high = std::max(high, static_cast<int>(std::ceil(std::log10(ratio))));
            }
    const bool cuts = high > most_decades;
    high = std::min(high, most_decades);
    const double left = margin + names_width, top = margin + 4 * line_height,
                 bottom = top + line_height * static_cast<double>(lines.size());
    const auto place = [&](double log10) {
        return left + (std::min<double>(log10, high) - low) / (high - low) * plot_width;
    };
    std::string body = text(margin, margin, axis);
    for (std::size_t s = 0; s < series.size(); ++s) {
        const double x = margin + 160 * static_cast<double>(s % 6),
                     y = margin + line_height * static_cast<double>(1 + s / 6);
        body += mark(x + 5, y - 4, s, series[s]) + text(x + 14, y, series[s]);
    }
    for (int e = low; e <= high; ++e)
        body += "<line x1=\"" + number(place(e)) + "\" y1=\"" + number(top) + "\" x2=\"" +
                number(place(e)) + "\" y2=\"" + number(bottom) + "\" stroke=\"#d9d9d9\"/>\n" +
                text(place(e), top - 4, (cuts && e == high ? "≥ 1e" : "1e") + std::to_string(e),
                     "text-anchor=\"middle\"");
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const auto& [name, ratios] = lines[i];
        const double y = top + line_height * (static_cast<double>(i) + 0.5);
        body += text(left - 10, y + 4, name, "text-anchor=\"end\"");
        for (std::size_t s = ratios.size(); s-- > 0;)  // the first series is on top
            if (is_drawn(ratios[s]))
                body += mark(place(std::log10(ratios[s])), y, s,
                             name + ", " + series[s] + ": " + detail::scientific(ratios[s]));
    }
    return svg_of(left + plot_width + 2 * margin, bottom + margin, body);
}

}  // namespace errbound::explaining
