// Paths of scopes are sorted, and their common beginnings share a bar.
#include "errbound/program/flame_graph.hpp"

#include <algorithm>
#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

#include "errbound/program/svg.hpp"

namespace errbound::explaining {
namespace {

constexpr double width = 1000, margin = 10, bar_height = 20, heading = 28;
constexpr double whole = width - 2 * margin;                     // a result's bar
constexpr double thinnest = 0.2, letter = 7.3, text_margin = 4;  // pixels, of 12 pixel monospace

struct frame {
    bool operation = false;
    std::string name, where{};  ///< for a scope: file:line

    friend auto operator<=>(const frame&, const frame&) = default;
};

/// The bars of one source, from the lowest to the highest.
struct pile {
    std::vector<frame> frames;
    double share = 0, amount = 0;
};

std::vector<pile> piles_of(const explanation& e) {
    std::vector<pile> piles;
    const std::vector<double> shares = shares_of(e);
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const contribution& c = e.contributions[i];
        pile p{{{false, detail::printable(e.name)}}, shares[i], c.amount};
        for (const place& s : c.scopes)
            p.frames.push_back({false, detail::printable(s.name),
                                detail::printable(s.file) + ':' + std::to_string(s.line)});
        p.frames.push_back({true, detail::printable(c.operation)});
        piles.push_back(std::move(p));
    }
    if (piles.empty()) piles.push_back({{{false, detail::printable(e.name)}}, 1, 0});
    std::sort(piles.begin(), piles.end(),
              [](const pile& p, const pile& q) { return p.frames < q.frames; });
    return piles;
}

std::string shortened(std::string_view text, double room) {
    const auto fit = static_cast<std::size_t>(std::max(0.0, (room - 2 * text_margin) / letter));
    std::size_t characters = 0, bytes = 0, kept = 0;
    while (bytes < text.size()) {
        bytes += detail::character_length(text.substr(bytes));
        if (++characters + 1 == fit) kept = bytes;
    }
    if (characters <= fit) return escaped(text);
    return fit < 3 ? std::string() : escaped(text.substr(0, kept)) + "…";
}

/// Warm colours for scopes, one per name; cooler for operations; grey for the rest.
std::string colour_of(const frame& f) {
    if (f.operation) return f.name == "the rest" ? "#c8c8c8" : "#b9d3e8";
    std::uint32_t hash = 2166136261U;
    for (const char c : f.name) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
    return "hsl(" + std::to_string(10 + hash % 40) + ",80%," + std::to_string(66 + hash / 64 % 12) +
           "%)";
}

std::string number(double x) {
    return detail::tenths(x);
}

struct bar {
    double left = 0, share = 0, amount = 0;
};

std::string drawn(const frame& f, const bar& b, double bottom) {
    const double wide = b.share * whole;
    if (!(wide >= thinnest)) return "";
    const std::string tip =
        f.name + (f.where.empty() ? "" : " (" + f.where + ")") + ": " + detail::percent(b.share) +
        (std::isfinite(b.amount) ? ", " + detail::scientific(b.amount) : ", unknown");
    std::string svg = "<g><title>" + escaped(tip) + "</title><rect x=\"" + number(b.left) +
                      "\" y=\"" + number(bottom - bar_height) + "\" width=\"" + number(wide) +
                      "\" height=\"" + number(bar_height - 1) + "\" fill=\"" + colour_of(f) +
                      "\" stroke=\"#fff\" stroke-width=\"0.5\"/>";
    if (const std::string text = shortened(f.name, wide); !text.empty())
        svg += "<text x=\"" + number(b.left + text_margin) + "\" y=\"" + number(bottom - 6) +
               "\">" + text + "</text>";
    return svg + "</g>\n";
}

std::string graph(const std::vector<pile>& piles, double bottom) {
    std::string svg;
    std::vector<bar> open;  // of the previous pile
    const std::vector<frame>* before = nullptr;
    const auto close_down_to = [&](std::size_t count) {
        for (; open.size() > count; open.pop_back()) {
            const std::size_t level = open.size() - 1;
            svg += drawn((*before)[level], open[level],
                         bottom - bar_height * static_cast<double>(level));
        }
    };
    double left = margin;
    for (const pile& p : piles) {
        std::size_t common = 0;
        while (before != nullptr && common < std::min(before->size(), p.frames.size()) &&
               (*before)[common] == p.frames[common])
            ++common;
        close_down_to(common);
        open.resize(p.frames.size(), {left});
        for (bar& b : open) {
            b.share += p.share;
            b.amount += p.amount;
        }
        before = &p.frames;
        left += p.share * whole;
    }
    close_down_to(0);
    return svg;
}

}  // namespace

std::string flame_graphs(const std::vector<explanation>& results) {
    std::string body;
    double top = 0;
    for (const explanation& e : results) {
        const std::vector<pile> piles = piles_of(e);
        std::size_t levels = 0;
        for (const pile& p : piles) levels = std::max(levels, p.frames.size());
        const std::string title =
            detail::heading_of(e) + (e.contributions.empty() ? ": no error" : "");
        body += "<text x=\"" + number(margin) + "\" y=\"" + number(top + heading - 9) + "\">" +
                shortened(title, whole) + "</text>\n";
        const double bottom = top + heading + bar_height * static_cast<double>(levels);
        body += graph(piles, bottom);
        top = bottom;
    }
    return svg_of(width, top + margin, body);
}

}  // namespace errbound::explaining
