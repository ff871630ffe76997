// Our PLY reader beside CGAL's.
#undef NDEBUG  // CGAL's assertions keep it from reading properties of other types than it expects
#include "tests/ccd/io/peers/ply_peer.hpp"

#include <CGAL/IO/PLY.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/assertions_behaviour.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <sstream>
#include <vector>

#include "ccd/io/text.hpp"
#include "tests/ccd/io/fuzz/same_mesh.hpp"
#include "tests/ccd/io/peers/words.hpp"

namespace ccd::peers {
namespace {

using words = std::vector<std::string>;

words words_of(std::string_view line) {
    words found;
    for (std::string_view word = io::take_word(line); !word.empty(); word = io::take_word(line))
        found.emplace_back(word);
    return found;
}

struct type {
    std::string_view name, other_name;
    double lowest, highest;
    bool whole;
};

constexpr double max_double = std::numeric_limits<double>::max();
constexpr std::array types{type{"char", "int8", -128, 127, true},
                           type{"uchar", "uint8", 0, 255, true},
                           type{"short", "int16", -32768, 32767, true},
                           type{"ushort", "uint16", 0, 65535, true},
                           type{"int", "int32", -2147483648.0, 2147483647, true},
                           type{"uint", "uint32", 0, 4294967295, true},
                           type{"float", "float32", -0x1.fffffep127, 0x1.fffffep127, false},
                           type{"double", "float64", -max_double, max_double, false}};

const type* type_of(std::string_view name) {
    for (const type& t : types)
        if (t.name == name || t.other_name == name) return &t;
    return nullptr;
}

struct property {
    const type* count;  ///< of a list
    const type* value;
    std::string name;
};

struct element {
    std::string name;
    std::uint64_t count;
    std::vector<property> properties;

    bool has(std::string_view wanted) const {
        return std::ranges::find(properties, wanted, &property::name) != properties.end();
    }
};

bool is_index_list(const property& p) {
    return p.count != nullptr && (p.name == "vertex_indices" || p.name == "vertex_index");
}

bool is_index(const property& p) {
    return is_index_list(p) || p.name == "vertex1" || p.name == "vertex2";
}

/// A text taken apart as far as it goes.
struct outline {
    std::vector<words> lines;  ///< the header's
    std::vector<element> elements;
    bool is_ascii = false, has_stray_property = false, has_odd_type = false;
    std::string_view body;

    explicit outline(std::string_view text) {
        while (!text.empty()) {
            std::string_view line = text.substr(0, text.find('\n'));
            text.remove_prefix(std::min(line.size() + 1, text.size()));
            if (line.ends_with('\r')) line.remove_suffix(1);
            std::istringstream stream{std::string(line)};  // with CGAL's blanks
            lines.emplace_back(std::istream_iterator<std::string>(stream),
                               std::istream_iterator<std::string>());
            if (!lines.back().empty()) add(lines.back());
            if (!lines.back().empty() && lines.back()[0] == "end_header") break;
        }
        body = text;
    }

  private:
    void add(const words& line) {
        if (line[0] == "format") is_ascii |= line.size() > 1 && line[1] == "ascii";
        if (line[0] == "element" && line.size() > 2)
            elements.push_back({line[1], std::strtoull(line[2].c_str(), nullptr, 10), {}});
        if (line[0] != "property" || line.size() < 3) return;
        const bool is_list = line[1] == "list";
        const type* const count = is_list ? type_of(line[2]) : nullptr;
        const type* const value = is_list && line.size() > 4 ? type_of(line[3]) : type_of(line[1]);
        has_stray_property |= elements.empty();
        if (value == nullptr || (is_list && (count == nullptr || !count->whole)))
            has_odd_type = true;
        else if (!elements.empty())
            elements.back().properties.push_back({count, value, line[is_list ? 4 : 2]});
    }
};

bool is_integer(const std::string& word) {
    const std::size_t sign = word.starts_with('+') || word.starts_with('-') ? 1 : 0;
    return word.size() > sign && word.find_first_not_of("0123456789", sign) == std::string::npos;
}

bool is_of_type(const std::string& word, const type& t) {
    if (t.whole && !is_integer(word)) return false;
    const char* begin = word.c_str();
    char* end = nullptr;
    const double value = std::strtod(begin, &end);
    return end == begin + word.size() && end != begin && value >= t.lowest && value <= t.highest &&
           word.find_first_of("xXnN") == std::string::npos;
}

/// Shows each value of an ascii body: what it belongs to, its type and spelling. Whether each line
/// that is not blank holds one element; it ends at a list of no known length.
template <class Show>
bool show_values(const outline& o, const Show& show) {
    std::string_view body = o.body;
    for (const element& e : o.elements) {
        if (e.properties.empty()) continue;
        for (std::uint64_t i = 0; i < e.count; ++i) {
            words line;
            while (line.empty()) {
                const std::optional<std::string_view> next = io::take_line(body);
                if (!next) return false;
                line = words_of(*next);
            }
            auto word = line.begin();
            for (const property& p : e.properties) {
                std::uint64_t count = 1;
                if (p.count != nullptr) {
                    if (word == line.end()) return false;
                    show(e, p, *p.count, *word);
                    if (!is_of_type(*word, *p.count)) return true;
                    count = std::strtoull(word++->c_str(), nullptr, 0);
                }
                for (; count > 0; --count) {
                    if (word == line.end()) return false;
                    show(e, p, *p.value, *word++);
                }
            }
            if (word != line.end()) return false;
        }
    }
    return true;
}

template <class Predicate>
bool any_value(std::string_view text, const Predicate& predicate) {
    const outline o(text);
    bool found = false;
    if (o.is_ascii)
        show_values(o, [&](const element& e, const property& p, const type& t,
                           const std::string& word) { found |= predicate(e, p, t, word); });
    return found;
}

bool is_used(const element& e, const property& p) {
    return (e.name == "vertex" && (p.name == "x" || p.name == "y" || p.name == "z")) ||
           (e.name == "face" && is_index_list(p)) || (e.name == "edge" && is_index(p));
}

template <class Predicate>
bool any_header_line(std::string_view text, const Predicate& predicate) {
    return std::ranges::any_of(outline(text).lines, predicate);
}

template <class Predicate>
bool any_element(std::string_view text, const Predicate& predicate) {
    return std::ranges::any_of(outline(text).elements, predicate);
}

bool is_odd_header_line(const words& line) {
    if (line.empty()) return true;
    const std::string& keyword = line[0];
    if (keyword == "comment" || keyword == "obj_info" || keyword == "end_header") return false;
    if (keyword == "ply") return line.size() != 1;
    if (keyword == "format") return line.size() != 3 || line[2] != "1.0";
    if (keyword == "element")
        return line.size() != 3 || line[2].find_first_not_of("0123456789") != std::string::npos;
    return keyword != "property" || line.size() != (line.size() > 1 && line[1] == "list" ? 5u : 3u);
}

bool has_doubled_name(std::string_view text) {
    const outline o(text);
    const auto doubled = [](const auto& all) {
        for (auto i = all.begin(); i != all.end(); ++i)
            if (std::find_if(all.begin(), i, [&](const auto& e) { return e.name == i->name; }) != i)
                return true;
        return false;
    };
    const auto lines_of = [&](const char* keyword) {
        return std::ranges::count_if(
            o.lines, [&](const words& line) { return !line.empty() && line[0] == keyword; });
    };
    return lines_of("ply") != 1 || lines_of("format") != 1 || doubled(o.elements) ||
           std::ranges::any_of(o.elements, [&](const element& e) { return doubled(e.properties); });
}

bool has_plural_name(std::string_view text) {
    return any_element(text,
                       [](const element& e) { return e.name == "vertices" || e.name == "faces"; });
}

constexpr outcome refused = outcome::we_refuse, read = outcome::peer_differs;

constexpr std::array differences{
    difference{refused,
               "header lines that it does not know, versions and words too many are skipped",
               [](std::string_view text) { return any_header_line(text, is_odd_header_line); },
               "ply\nformat ascii 2.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
               "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
    difference{refused, "elements, properties and lines of ply or format may come twice",
               has_doubled_name,
               "ply\nformat ascii 1.0\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
               "property float y\nproperty float z\nelement face 1\n"
               "property list uchar int vertex_indices\n"
               "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
    difference{refused, "properties of unknown types have no values",
               [](std::string_view text) { return outline(text).has_odd_type; },
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nproperty half w\nelement face 1\n"
               "property list uchar int vertex_indices\n"
               "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
    difference{refused, "elements without properties are counted through",
               [](std::string_view text) {
                   return any_element(
                       text, [](const element& e) { return e.count > 0 && e.properties.empty(); });
               },
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nelement nothing 5\nelement face 1\n"
               "property list uchar int vertex_indices\n"
               "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
    difference{refused, "vertices and faces are elements as vertex and face", has_plural_name,
               "ply\nformat ascii 1.0\nelement vertices 3\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
               "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
    difference{refused, "absent coordinates are 0",
               [](std::string_view text) {
                   return any_element(text, [](const element& e) {
                       return e.name == "vertex" && !(e.has("x") && e.has("y") && e.has("z"));
                   });
               },
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "element face 1\nproperty list uchar int vertex_indices\n"
               "end_header\n0 0\n1 0\n0 1\n3 0 1 2\n"},
    difference{refused, "of two lists of indices one is read",
               [](std::string_view text) {
                   return any_element(text, [](const element& e) {
                       return e.name == "face" &&
                              std::ranges::count_if(e.properties, is_index_list) > 1;
                   });
               },
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
               "property list uchar int vertex_index\n"
               "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 3 0 1 2\n"},
    difference{refused, "edges, strips and other elements are skipped with the indices in them",
               [](std::string_view text) {
                   return any_element(text, [](const element& e) {
                       return e.count > 0 && e.name != "vertex" && e.name != "face" &&
                              (e.name == "edge" || std::ranges::any_of(e.properties, is_index));
                   });
               },
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
               "element edge 1\nproperty int vertex1\nproperty int vertex2\n"
               "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n7 7\n"},
    difference{refused, "an element may take several lines, or share one",
               [](std::string_view text) {
                   const outline o(text);
                   return o.is_ascii && !show_values(o, [](const auto&...) {});
               },
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
               "end_header\n0 0 0 1 0 0\n0 1 0\n3 0 1 2\n"},
    difference{refused, "integers beyond their type are taken modulo its size",
               [](std::string_view text) {
                   return any_value(text, [](const element&, const property&, const type& t,
                                             const std::string& word) {
                       return t.whole && is_integer(word) && !is_of_type(word, t);
                   });
               },
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
               "end_header\n0 0 0\n1 0 0\n0 1 0\n259 0 1 2\n"},
    difference{refused, "carriage returns, vertical tabs and form feeds are blanks",
               [](std::string_view text) { return text.find_first_of("\r\v\f") != text.npos; },
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
               "end_header\n0 0 0\v\n1 0 0\n0 1 0\n3 0 1 2\n"},
    difference{refused, "names may have control characters in them",
               [](std::string_view text) {
                   return any_header_line(text, [](const words& line) {
                       return !line.empty() && line[0] != "comment" && line[0] != "obj_info" &&
                              std::ranges::any_of(line, [](const std::string& word) {
                                  return std::ranges::any_of(word, io::is_control);
                              });
                   });
               },
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
               "element ed\x05 0\n"
               "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
    difference{read, "the format must be told in the second line",
               [](std::string_view text) {
                   const outline o(text);
                   return o.lines.size() > 1 && !o.lines[1].empty() && o.lines[1][0] != "format";
               },
               "ply\ncomment first\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
               "property float y\nproperty float z\nelement face 1\n"
               "property list uchar int vertex_indices\n"
               "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
    difference{read, "faces must have a list of indices of type int or uint, no face too",
               [](std::string_view text) {
                   return any_element(text, [](const element& e) {
                       const auto list = std::ranges::find_if(e.properties, is_index_list);
                       return e.name == "face" &&
                              (list == e.properties.end() ||
                               (list->value->name != "int" && list->value->name != "uint"));
                   });
               },
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar short vertex_indices\n"
               "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
    difference{read, "coordinates must be floats or doubles",
               [](std::string_view text) {
                   return any_element(text, [](const element& e) {
                       return std::ranges::any_of(e.properties, [&](const property& p) {
                           return e.name == "vertex" && is_used(e, p) && p.value->whole;
                       });
                   });
               },
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty short x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
               "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
    difference{read, "values that we skip must be of their types too",
               [](std::string_view text) {
                   return any_value(text, [](const element& e, const property& p, const type& t,
                                             const std::string& word) {
                       return !is_used(e, p) && !is_of_type(word, t);
                   });
               },
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nproperty int w\nelement face 1\n"
               "property list uchar int vertex_indices\n"
               "end_header\n0 0 0 none\n1 0 0 1\n0 1 0 1\n3 0 1 2\n"},
    difference{read, "integers may not be spelled with a point or an exponent",
               [](std::string_view text) {
                   return any_value(text, [](const element& e, const property& p, const type& t,
                                             const std::string& word) {
                       return is_used(e, p) && t.whole && !is_integer(word);
                   });
               },
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
               "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2.0\n"},
    difference{read, "vertices and faces are elements as vertex and face", has_plural_name,
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
               "element vertices 1\nproperty float x\n"
               "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n0\n"},
};

/// Carriage returns that end the header's lines alone as line feeds.
std::string with_line_feeds(std::string_view text) {
    std::string result(text);
    const std::size_t first = text.find_first_of("\r\n");
    if (first == text.npos || text[first] == '\n' || text.substr(first).starts_with("\r\n"))
        return result;
    const std::size_t last = std::min(text.find("\rend_header\r"), text.size());
    std::replace(result.begin(), result.begin() + static_cast<std::ptrdiff_t>(last), '\r', '\n');
    if (last < text.size())
        result[last] = result[last + std::string_view("\rend_header").size()] = '\n';
    return result;
}

constexpr std::array rewritings{
    rewriting{"a byte order mark is no part of ply",
              [](std::string_view text) {
                  return std::string(text.substr(text.starts_with("\xef\xbb\xbf") ? 3 : 0));
              },
              "\xef\xbb\xbfply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
              "property float y\nproperty float z\nelement face 1\n"
              "property list uchar int vertex_indices\n"
              "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
    rewriting{"a carriage return alone ends no line", with_line_feeds,
              "ply\rformat ascii 1.0\relement vertex 3\rproperty float x\rproperty float y\r"
              "property float z\relement face 1\rproperty list uchar int vertex_indices\r"
              "end_header\r0 0 0\r1 0 0\r0 1 0\r3 0 1 2\r"},
    rewriting{"of a hexadecimal number it reads the 0 before the x",
              [](std::string_view text) {
                  return outline(text).is_ascii ? with_decimals(text) : std::string(text);
              },
              "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
              "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
              "end_header\n0 0 0x1p-3\n1 0 0\n0 1 0\n3 0 1 2\n"},
};

/// What CGAL cannot be given: a property of no element (it takes the second line for the format
/// whatever it says), elements without bytes that it counts through, and lists as long as they
/// claim to be, or, after a value that is not of its type, as long as chance has it.
bool harms_cgal(std::string_view text, bool is_taken_by_us) {
    const outline o(text);
    const bool mistakes_line = o.lines.size() > 1 && !o.lines[1].empty() &&
                               (o.lines[1][0] == "element" || o.lines[1][0] == "end_header");
    const bool has_odd_value =
        any_value(text, [](const element&, const property&, const type& t,
                           const std::string& word) { return !is_of_type(word, t); });
    return o.has_stray_property || mistakes_line ||
           std::ranges::any_of(o.elements, [&](const element& e) {
               const bool may_be_long = std::ranges::any_of(e.properties, [](const property& p) {
                   return p.count && p.count->highest > 1e5;
               });
               return (e.properties.empty() && e.count > 1000) ||
                      (may_be_long && (!is_taken_by_us || has_odd_value));
           });
}

/// The mesh that CGAL takes the text for, if that is a mesh of triangles to the end of the text.
std::optional<mesh> read_by_cgal(std::string_view text) {
    CGAL::set_error_handler([](const char*, const char*, const char*, int, const char*) {});
    std::vector<CGAL::Simple_cartesian<double>::Point_3> points;
    std::vector<std::vector<std::size_t>> polygons;
    std::istringstream stream{std::string(text)};
    try {
        if (!CGAL::IO::read_PLY(stream, points, polygons, CGAL::parameters::verbose(false)))
            return std::nullopt;
    } catch (const std::logic_error&) {  // an assertion, or a list of negative length
        return std::nullopt;
    }
    stream.clear();
    const std::string rest(std::istreambuf_iterator<char>(stream), {});
    if (rest.find_first_not_of(outline(text).is_ascii ? " \t\r\n" : "") != rest.npos)
        return std::nullopt;
    mesh m;
    for (const auto& p : points) m.vertices.push_back({p.x(), p.y(), p.z()});
    for (const std::vector<std::size_t>& polygon : polygons) {
        if (polygon.size() != 3) return std::nullopt;
        face& corners = m.faces.emplace_back();
        std::ranges::transform(polygon, corners.begin(), [](std::size_t i) {
            return static_cast<vertex_index>(std::min<std::size_t>(i, UINT32_MAX));
        });
    }
    if (!is_sound(m)) return std::nullopt;
    return m;
}

}  // namespace

outcome compare_ply(std::string_view text, std::string_view given) {
    std::optional<mesh> ours = read_by(io::parse_mesh_ply, text);
    if (harms_cgal(given, ours.has_value())) return outcome::same;
    const std::optional<mesh> peers = read_by_cgal(given);
    if (!ours) return peers ? outcome::we_refuse : outcome::same;
    ours->edges.clear();
    const bool agree =
        peers && ours->vertices.size() == peers->vertices.size() && fuzz::same_mesh(*ours, *peers);
    return agree ? outcome::same : outcome::peer_differs;
}

std::span<const rewriting> ply_rewritings() {
    return rewritings;
}

std::span<const difference> ply_differences() {
    return differences;
}

}  // namespace ccd::peers
