// Our OBJ reader compared with tinyobjloader's.
#include <tiny_obj_loader.h>

#include <array>
#include <boost/algorithm/string/replace.hpp>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <utility>

#include "tests/ccd/io/meshes.hpp"
#include "tests/ccd/io/peers/peer.hpp"

namespace ccd::peers {
namespace {

/// The position of a line's comment: a '#' that begins a word.
std::size_t comment_start(std::string_view line) {
    std::size_t at = line.find('#');
    while (at != line.npos && at > 0 && line[at - 1] != ' ' && line[at - 1] != '\t')
        at = line.find('#', at + 1);
    return at;
}

/// True if a line's words, without its comment, satisfy the condition.
template <class Condition>
predicate some_line(const Condition& holds) {
    return [holds](std::string_view text) {
        while (std::optional<std::string_view> line = io::take_line(text)) {
            const words of_line = words_of(line->substr(0, comment_start(*line)));
            if (!of_line.empty() && holds(of_line)) return true;
        }
        return false;
    };
}

/// True if a word after one of these keywords, letters, satisfies the condition.
template <class Condition>
predicate some_word(std::string_view keywords, const Condition& holds) {
    return some_line([=](const words& line) {
        return line[0].size() == 1 && keywords.find(line[0]) != std::string_view::npos &&
               std::any_of(line.begin() + 1, line.end(), holds);
    });
}

bool is_decimal(std::string_view word) {
    if (word.starts_with('+') || word.starts_with('-')) word.remove_prefix(1);
    double value = 0;
    const char* const end = word.data() + word.size();
    return word.find_first_of("0123456789.") == 0 &&
           std::from_chars(word.data(), end, value).ptr == end;
}

bool overflows(const std::string& word) {
    return is_decimal(word) && std::isinf(std::strtod(word.c_str(), nullptr));
}

/// True if tinyobjloader's sums of digits and powers of 5 may overflow.
bool is_extreme(const std::string& word) {
    const std::size_t e = word.find_first_of("eE");
    const bool far = e != std::string::npos && std::abs(std::atof(word.c_str() + e + 1)) > 400;
    return is_decimal(word) && (far || std::min(e, word.size()) > 300 ||
                                std::abs(std::strtod(word.c_str(), nullptr)) > 1.79e308);
}

/// The numbers of v, v/vt, v//vn or v/vt/vn: absent ones are 1, or 0 after a slash. Nothing if one
/// is not an integer.
std::optional<std::array<std::int64_t, 3>> corner(std::string_view word) {
    std::array<std::int64_t, 3> parts{1, 1, 1};
    for (std::size_t part = 0; part < parts.size(); ++part) {
        const std::string_view token = word.substr(0, word.find('/'));
        const char* const end = token.data() + token.size();
        const bool absent = part > 0 && token.empty();
        if (absent) parts[part] = part == 1 && word.size() > 0 ? 1 : 0;
        const bool plus = token.starts_with('+') && !token.starts_with("+-");
        const auto [stop, error] = std::from_chars(token.data() + plus, end, parts[part]);
        if (!absent && (error != std::errc{} || stop != end)) return std::nullopt;
        if (token.size() == word.size()) return parts;
        word.remove_prefix(token.size() + 1);
    }
    return std::nullopt;
}

bool is_no_corner(const std::string& word) {
    const auto parts = corner(word);
    return !parts || !std::in_range<int>((*parts)[0]);
}

/// True for an int, whose lowest bits tinyobjloader takes, that is 0.
bool is_zero(std::int64_t index) {
    return static_cast<std::uint32_t>(index) == 0;
}

bool has_control(std::string_view text) {
    return std::ranges::any_of(text,
                               [](char c) { return io::is_control(c) && c != '\n' && c != '\r'; });
}

bool ends_in_backslash(std::string_view text) {
    while (std::optional<std::string_view> line = io::take_line(text))
        if (line->ends_with('\\')) return true;
    return false;
}

bool has_unknown_keyword(const words& line) {
    constexpr std::array<std::string_view, 11> common{"v", "vt", "vn", "f",      "l",     "p",
                                                      "g", "o",  "s",  "usemtl", "mtllib"};
    return std::ranges::find(common, line[0]) == common.end();
}

/// True if there are edges, and a group begins after them.
bool loses_edges(std::string_view text) {
    bool has_edges = false;
    return some_line([&](const words& line) {
        has_edges |= line[0] == "l";
        return has_edges && line[0] == "g";
    })(text);
}

const std::vector<difference> differences{
    we_refuse("reads absent coordinates as 0, skips numbers after the colour",
              some_line([](const words& line) {
                  const std::size_t count = line.size() - 1;
                  return line[0] == "v" && (count < 3 || count == 5 || count > 7);
              }),
              {"v 0 0 0", "v 0 0"}),
    we_refuse("reads a word as the number that it begins with, or as 0",
              some_word("v", [](const std::string& word) { return !is_decimal(word); }),
              {"v 0 0 0", "v 0 0 zero"}),
    we_refuse("reads numbers that overflow as 0, or skips them", some_word("v", overflows),
              {"v 0 0 0", "v 0 0 1e9999999999"}),
    we_refuse("skips a vertex's weight", some_line([](const words& line) {
                  return line[0] == "v" && line.size() == 5 &&
                         std::strtod(line[4].c_str(), nullptr) != 1;
              }),
              {"v 0 0 0", "v 0 0 0 2"}),
    we_refuse("reads an index as the integer that a word begins with",
              some_word("flp", is_no_corner), {"f 1 2 3", "f 1 2 3.5"}),
    we_refuse("skips f, l and p without indices", some_line([](const words& line) {
                  return line.size() == 1 && (line[0] == "f" || line[0] == "l" || line[0] == "p");
              }),
              {"f 1 2 3", "f 1 2 3\nf"}),
    we_refuse("skips unknown keywords, also curves and misspelt ones",
              some_line(has_unknown_keyword), {"f 1 2 3", "f 1 2 3\nface 1 2 3"}),
    we_refuse("reads control characters as others; NUL ends a line", has_control,
              {"f 1 2 3", "f 1 2 3\no \x01"}),
    we_refuse("does not join a line with a backslash to the next", ends_in_backslash,
              {"f 1 2 3", "f 1 2 3\no a\\"}),
    we_refuse("loses edges of a group without faces if another group begins", loses_edges,
              {"f 1 2 3", "l 1 9\ng next\nf 1 2 3"}),
    peer_differs("refuses texture and normal indices whose low 32 bits are 0, or that are absent "
                 "after a slash",
                 some_word("flp",
                           [](const std::string& word) {
                               const auto parts = corner(word);
                               return parts && (is_zero((*parts)[1]) || is_zero((*parts)[2]));
                           }),
                 {"f 1 2 3", "f 1/4294967296 2 3"}),
    peer_differs("loses edges of a group without faces if another group begins", loses_edges,
                 {"f 1 2 3", "l 1 2\ng next\nf 1 2 3"}),
    peer_differs("overflows in sums of digits and powers of 5", some_word("v", is_extreme),
                 {"v 0 0 0", "v 0 0 0e999"}),
};

std::string without_comment(const std::string& line) {
    return line.substr(0, comment_start(line));
}

std::string with_lines_joined(std::string text) {
    for (const char* end : {"\\\r\n", "\\\n", "\\\r"}) boost::replace_all(text, end, " ");
    return text;
}

std::string with_one_blank_after_l(const std::string& line) {
    constexpr const char* blanks = " \t";
    const std::size_t first = line.find_first_not_of(blanks);
    if (first == line.npos || line[first] != 'l') return line;
    const std::size_t next = std::min(line.find_first_not_of(blanks, first + 1), line.size());
    return next < first + 3 ? line : line.substr(0, first + 2) + line.substr(next);
}

/// A rewriting of each line.
auto on_lines(std::string (*rewritten)(const std::string&)) {
    return [=](std::string_view text) { return exchange(text, "\r\n", rewritten); };
}

const std::vector<rewriting> rewritings{
    {"does not know a byte order mark",
     without_byte_order_mark,
     {"v 0 0 0", "\xef\xbb\xbfv 0 0 0"}},
    {"reads comments only on separate lines",
     on_lines(without_comment),
     {"f 1 2 3", "f 1 2 3 # all"}},
    {"does not join a line with a backslash to the next",
     [](std::string_view text) { return with_lines_joined(std::string(text)); },
     {"f 1 2 3", "f 1 2 \\\n3"}},
    {"reads the first index after l and two blanks twice",
     on_lines(with_one_blank_after_l),
     {"f 1 2 3", "l  1 2"}},
    {"reads only the 0 before the x of a hexadecimal number",
     with_decimals,
     {"v 0 0 0", "v 0 0 0x1p0"}},
    {"skips fo, an old word for f",
     [](std::string_view text) {
         return exchange_words(text,
                               [](const std::string& word) { return word == "fo" ? "f" : word; });
     },
     {"f 1 2 3", "f 1 2 3\nfo 2 1 3"}},
};

/// The mesh that tinyobjloader reads, if it consists of triangles and edges.
std::optional<mesh> read_by_tinyobjloader(std::string_view text) {
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::string warning, error;
    std::istringstream stream{std::string(text)};
    if (!tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, &stream, nullptr,
                          false) ||
        warning.find("Degenerated face") != std::string::npos)
        return std::nullopt;
    mesh m;
    const std::vector<double>& v = attributes.vertices;
    for (std::size_t i = 0; i < v.size(); i += 3) m.vertices.push_back({v[i], v[i + 1], v[i + 2]});
    const auto index = [](const tinyobj::index_t& i) {
        return static_cast<vertex_index>(i.vertex_index);  // negative ones are out of range
    };
    std::vector<vertex_index> points;
    for (const tinyobj::shape_t& shape : shapes) {
        if (std::ranges::any_of(shape.mesh.num_face_vertices, [](int n) { return n != 3; }))
            return std::nullopt;
        const std::vector<tinyobj::index_t>& corners = shape.mesh.indices;
        for (std::size_t i = 0; i < corners.size(); i += 3)
            m.faces.push_back({index(corners[i]), index(corners[i + 1]), index(corners[i + 2])});
        auto next = shape.lines.indices.begin();
        for (const tinyobj::index_t& i : shape.points.indices) points.push_back(index(i));
        for (const int count : shape.lines.num_line_vertices) {
            if (count < 2) return std::nullopt;
            for (const auto last = next + (count - 1); next != last; ++next)
                m.edges.push_back({index(*next), index(*(next + 1))});
            ++next;
        }
    }
    for (const vertex_index v : points) {  // after all elements, which may have it
        const auto has_it = [v](const auto& e) { return std::ranges::find(e, v) != e.end(); };
        if (std::ranges::none_of(m.faces, has_it) && std::ranges::none_of(m.edges, has_it))
            m.edges.push_back({v, v});
    }
    if (!test_meshes::is_sound(m) || m.vertices.empty()) return std::nullopt;
    return m;
}

/// True if tinyobjloader may have read `x` as `peers`: it sums up digits in doubles.
bool is_near(double x, double peers, std::size_t digits) {
    const double roundings = 2 * static_cast<double>(digits) + 8;
    return std::signbit(x) == std::signbit(peers) &&
           std::abs(x - peers) <= roundings * 0x1p-53 * std::abs(x) + 0x1p-1074;
}

bool same(const mesh& ours, const mesh& peers, std::string_view text) {
    std::size_t digits = 0;
    some_word("v", [&digits](const std::string& word) {
        digits = std::max(digits, word.size());
        return false;
    })(text);
    return ours.faces == peers.faces && ours.edges == peers.edges &&
           std::ranges::equal(ours.vertices, peers.vertices,
                              [&](const point<double>& p, const point<double>& q) {
                                  return is_near(p.x, q.x, digits) && is_near(p.y, q.y, digits) &&
                                         is_near(p.z, q.z, digits);
                              });
}

outcome compare(std::string_view text, std::string_view given) {
    // tinyobjloader reserves the memory that tags of subdivision surfaces claim to need.
    if (some_line([](const words& line) { return line[0] == "t"; })(given)) return outcome::same;
    const std::optional<mesh> ours = read_by(io::parse_mesh_obj, text);
    const std::optional<mesh> peers = read_by_tinyobjloader(given);
    if (!ours) return peers ? outcome::we_refuse : outcome::same;
    return peers && same(*ours, *peers, given) ? outcome::same : outcome::peer_differs;
}

}  // namespace

const peer& the_peer() {
    static const peer tinyobjloader{
        compare,
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf -3/1/1 -2//1 -1/1\nl 1 2 3\nv 1 0.1 1e-5\n",
        rewritings,
        differences,
        test_meshes::texts(
            "v|f|l|p|vn|vt|g a|o b|s 1|usemtl m|fo|V|curv|mtllib m|vp|#|# c|1/1|2//2|3/3/3"
            "|-1/-1|1/0|f 1 2 3|l 1 2"),
        fuzz::spelled_obj};
    return tinyobjloader;
}

}  // namespace ccd::peers
