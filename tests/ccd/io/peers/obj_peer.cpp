// Our OBJ reader beside tinyobjloader's.
#include "tests/ccd/io/peers/obj_peer.hpp"

#include <tiny_obj_loader.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <utility>
#include <vector>

#include "ccd/io/text.hpp"
#include "tests/ccd/io/peers/words.hpp"

namespace ccd::peers {
namespace {

using words = std::vector<std::string>;

/// Where the comment of a line begins: at a '#' that begins a word.
std::size_t comment_start(std::string_view line) {
    std::size_t at = line.find('#');
    while (at != line.npos && at > 0 && line[at - 1] != ' ' && line[at - 1] != '\t')
        at = line.find('#', at + 1);
    return at;
}

/// The words of each line, without its comment.
template <class Predicate>
bool any_line(std::string_view text, const Predicate& predicate) {
    while (std::optional<std::string_view> line = io::take_line(text)) {
        std::string_view rest = line->substr(0, comment_start(*line));
        words of_line;
        for (std::string_view word = io::take_word(rest); !word.empty(); word = io::take_word(rest))
            of_line.emplace_back(word);
        if (!of_line.empty() && predicate(of_line)) return true;
    }
    return false;
}

/// Whether a line with this keyword has a word after it for which the predicate holds.
template <class Predicate>
bool any_word(std::string_view text, std::string_view keywords, const Predicate& predicate) {
    return any_line(text, [&](const words& line) {
        return line[0].size() == 1 && keywords.find(line[0]) != std::string_view::npos &&
               std::any_of(line.begin() + 1, line.end(), predicate);
    });
}

bool is_decimal(std::string_view word) {
    const auto take_digits = [&word] {
        const std::size_t digits = std::min(word.find_first_not_of("0123456789"), word.size());
        word.remove_prefix(digits);
        return digits;
    };
    const auto take_one_of = [&word](std::string_view characters) {
        const bool found = !word.empty() && characters.find(word[0]) != std::string_view::npos;
        if (found) word.remove_prefix(1);
        return found;
    };
    take_one_of("+-");
    std::size_t digits = take_digits();
    if (take_one_of(".")) digits += take_digits();
    if (digits == 0) return false;
    if (take_one_of("eE")) {
        take_one_of("+-");
        if (take_digits() == 0) return false;
    }
    return word.empty();
}

bool overflows(const std::string& word) {
    return is_decimal(word) && std::isinf(std::strtod(word.c_str(), nullptr));
}

/// Whether tinyobjloader's sums of digits and powers of 5 may leave the doubles on the way.
bool is_extreme(const std::string& word) {
    const std::size_t e = word.find_first_of("eE");
    const bool far = e != std::string::npos && std::abs(std::atof(word.c_str() + e + 1)) > 400;
    return is_decimal(word) && (far || std::min(e, word.size()) > 300 ||
                                std::abs(std::strtod(word.c_str(), nullptr)) > 1.79e308);
}

/// The numbers of v, v/vt, v//vn or v/vt/vn: absent ones as 1, or 0 after a slash. None where one
/// is no integer.
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

/// As an int, of which tinyobjloader takes the lowest bits.
bool is_zero(std::int64_t index) {
    return static_cast<std::uint32_t>(index) == 0;
}

bool ends_in_backslash(std::string_view text) {
    while (std::optional<std::string_view> line = io::take_line(text))
        if (line->ends_with('\\')) return true;
    return false;
}

bool has_control(std::string_view text) {
    return std::ranges::any_of(text, [](char c) {
        return (static_cast<unsigned char>(c) < ' ' && c != '\t' && c != '\n' && c != '\r') ||
               c == 0x7f;
    });
}

bool has_unknown_keyword(std::string_view text) {
    constexpr std::array<std::string_view, 11> common{"v", "vt", "vn", "f",      "l",     "p",
                                                      "g", "o",  "s",  "usemtl", "mtllib"};
    return any_line(text, [&](const words& line) {
        return std::ranges::find(common, line[0]) == common.end();
    });
}

/// Whether there are edges, and a group begins after them.
bool loses_edges(std::string_view text) {
    bool has_edges = false;
    return any_line(text, [&](const words& line) {
        has_edges |= line[0] == "l";
        return has_edges && line[0] == "g";
    });
}

constexpr outcome refused = outcome::we_refuse, read = outcome::peer_differs;

constexpr std::array differences{
    difference{refused, "absent coordinates are 0, numbers after the colour are skipped",
               [](std::string_view text) {
                   return any_line(text, [](const words& line) {
                       const std::size_t count = line.size() - 1;
                       return line[0] == "v" && (count < 3 || count == 5 || count > 7);
                   });
               },
               "v 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
    difference{refused, "what is no number is 0, or the number that it begins with",
               [](std::string_view text) {
                   return any_word(text, "v",
                                   [](const std::string& word) { return !is_decimal(word); });
               },
               "v 0 0 zero\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
    difference{refused, "numbers beyond the doubles are 0 for their exponent, or not looked at",
               [](std::string_view text) { return any_word(text, "v", overflows); },
               "v 0 0 1e9999999999\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
    difference{refused, "a vertex's weight is skipped",
               [](std::string_view text) {
                   return any_line(text, [](const words& line) {
                       return line[0] == "v" && line.size() == 5 &&
                              std::strtod(line[4].c_str(), nullptr) != 1;
                   });
               },
               "v 0 0 0 2\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
    difference{refused, "an index is the integer that a word begins with",
               [](std::string_view text) { return any_word(text, "flp", is_no_corner); },
               "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3.5\n"},
    difference{refused, "f, l and p without indices are skipped",
               [](std::string_view text) {
                   return any_line(text, [](const words& line) {
                       return line.size() == 1 &&
                              (line[0] == "f" || line[0] == "l" || line[0] == "p");
                   });
               },
               "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf\n"},
    difference{refused, "keywords that it does not know are skipped, curves and misspelt ones too",
               has_unknown_keyword, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nface 1 2 3\n"},
    difference{refused, "control characters are as others, and NUL ends a line", has_control,
               "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no \x01\n"},
    difference{refused, "a backslash at the end of a line does not join it to the next",
               ends_in_backslash, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no a\\\n"},
    difference{refused, "edges of a group without faces are lost where the next group begins",
               loses_edges, "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 9\ng next\nf 1 2 3\n"},
    difference{
        read,
        "the lowest bits of indices of textures and normals may not be 0, nor these be left out "
        "after a slash",
        [](std::string_view text) {
            return any_word(text, "flp", [](const std::string& word) {
                const auto parts = corner(word);
                return parts && (is_zero((*parts)[1]) || is_zero((*parts)[2]));
            });
        },
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/4294967296 2 3\n"},
    difference{read, "edges of a group without faces are lost where the next group begins",
               loses_edges, "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\ng next\nf 1 2 3\n"},
    difference{read, "sums of digits and powers of 5 overflow for numbers that do not",
               [](std::string_view text) { return any_word(text, "v", is_extreme); },
               "v 0 0 0e999\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
};

std::string without_comments(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const std::size_t size = std::min(text.find_first_of("\r\n"), text.size());
        const std::string_view line = text.substr(0, size);
        result += line.substr(0, comment_start(line));
        result += text.substr(size, 1);
        text.remove_prefix(std::min(size + 1, text.size()));
    }
    return result;
}

std::string with_lines_joined(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const std::size_t size = text.starts_with("\\\r\n")                             ? 3
                                 : text.starts_with("\\\n") || text.starts_with("\\\r") ? 2
                                                                                        : 0;
        result += size > 0 ? ' ' : text.front();
        text.remove_prefix(std::max<std::size_t>(size, 1));
    }
    return result;
}

std::string with_one_blank_after_l(std::string_view text) {
    constexpr std::string_view blanks = " \t";
    std::string result;
    bool starts = true;  // the line, but for blanks
    while (!text.empty()) {
        const char c = text.front();
        result += c;
        text.remove_prefix(1);
        const std::size_t skipped = std::min(text.find_first_not_of(blanks), text.size());
        if (starts && c == 'l' && skipped > 1) text.remove_prefix(skipped - 1);
        starts = c == '\n' || c == '\r' || (starts && blanks.find(c) != blanks.npos);
    }
    return result;
}

constexpr std::array rewritings{
    rewriting{"a byte order mark makes the first keyword an unknown one",
              [](std::string_view text) {
                  return std::string(text.substr(text.starts_with("\xef\xbb\xbf") ? 3 : 0));
              },
              "\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
    rewriting{"a comment must be a line of its own", without_comments,
              "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 # all\n"},
    rewriting{"a backslash at the end of a line does not join it to the next", with_lines_joined,
              "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 \\\n3\n"},
    rewriting{"after l and two blanks it reads the first index twice", with_one_blank_after_l,
              "v 0 0 0\nv 1 0 0\nl  1 2\n"},
    rewriting{"of a hexadecimal number it reads the 0 before the x", with_decimals,
              "v 0 0 0x1p0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
    rewriting{"fo, an old word for f, is skipped",
              [](std::string_view text) {
                  return exchange_words(
                      text, [](const std::string& word) { return word == "fo" ? "f" : word; });
              },
              "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nfo 2 1 3\n"},
};

/// Tags of subdivision surfaces make tinyobjloader reserve what they claim to hold.
bool exhausts_memory(std::string_view text) {
    return any_line(text, [](const words& line) { return line[0] == "t"; });
}

/// The mesh that tinyobjloader takes the text for, if that is a mesh of triangles and edges.
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
    if (!is_sound(m) || m.vertices.empty()) return std::nullopt;
    return m;
}

/// Whether tinyobjloader, rounding at each digit, may have read `x` as `peers`.
bool is_near(double x, double peers, std::size_t digits) {
    const double roundings = 2 * static_cast<double>(digits) + 8;
    return std::signbit(x) == std::signbit(peers) &&
           std::abs(x - peers) <= roundings * 0x1p-53 * std::abs(x) + 0x1p-1074;
}

bool same(const mesh& ours, const mesh& peers, std::string_view text) {
    std::size_t digits = 0;
    any_word(text, "v", [&](const std::string& word) {
        digits = std::max(digits, word.size());
        return false;
    });
    return ours.faces == peers.faces && ours.edges == peers.edges &&
           std::ranges::equal(ours.vertices, peers.vertices,
                              [&](const point<double>& p, const point<double>& q) {
                                  return is_near(p.x, q.x, digits) && is_near(p.y, q.y, digits) &&
                                         is_near(p.z, q.z, digits);
                              });
}

}  // namespace

outcome compare_obj(std::string_view text, std::string_view given) {
    if (exhausts_memory(given)) return outcome::same;
    const std::optional<mesh> ours = read_by(io::parse_mesh_obj, text);
    const std::optional<mesh> peers = read_by_tinyobjloader(given);
    if (!ours) return peers ? outcome::we_refuse : outcome::same;
    return peers && same(*ours, *peers, given) ? outcome::same : outcome::peer_differs;
}

std::span<const rewriting> obj_rewritings() {
    return rewritings;
}

std::span<const difference> obj_differences() {
    return differences;
}

}  // namespace ccd::peers
