// Our PLY reader compared with CGAL's.
#undef NDEBUG  // CGAL's assertions keep it from reading properties of other types than it expects
#include <CGAL/IO/PLY.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/assertions_behaviour.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <sstream>
#include <vector>

#include "tests/ccd/io/meshes.hpp"
#include "tests/ccd/io/peers/peer.hpp"

namespace ccd::peers {
namespace {

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

bool is_coordinate(const property& p) {
    return p.name == "x" || p.name == "y" || p.name == "z";
}

bool is_index_list(const property& p) {
    return p.count != nullptr && (p.name == "vertex_indices" || p.name == "vertex_index");
}

bool is_index(const property& p) {
    return is_index_list(p) || p.name == "vertex1" || p.name == "vertex2";
}

/// The header of a text, as far as it can be read, and its body.
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

/// A word of an ascii body, and the number that the header promises there.
struct value {
    const element& of;
    const property& in;
    const type& declared;
    const std::string& word;

    bool is_used() const {
        return (of.name == "vertex" && is_coordinate(in)) ||
               (of.name == "face" && is_index_list(in)) || (of.name == "edge" && is_index(in));
    }
    bool fits() const { return is_of_type(word, declared); }
};

/// Calls show(value) for each value of an ascii body, up to a list of unknown length. True if each
/// line that is not blank holds one element.
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
                    show(value{e, p, *p.count, *word});
                    if (!is_of_type(*word, *p.count)) return true;
                    count = std::strtoull(word++->c_str(), nullptr, 0);
                }
                for (; count > 0; --count) {
                    if (word == line.end()) return false;
                    show(value{e, p, *p.value, *word++});
                }
            }
            if (word != line.end()) return false;
        }
    }
    return true;
}

/// True if a value of an ascii body satisfies the condition.
template <class Condition>
predicate some_value(const Condition& holds) {
    return [holds](std::string_view text) {
        const outline o(text);
        bool found = false;
        if (o.is_ascii) show_values(o, [&](const value& v) { found |= holds(v); });
        return found;
    };
}

/// True if an element, or a line of the header, satisfies the condition.
template <auto Member, class Condition>
predicate some(const Condition& holds) {
    return [holds](std::string_view text) {
        return std::ranges::any_of(outline(text).*Member, holds);
    };
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

bool has_plural_name(const element& e) {
    return e.name == "vertices" || e.name == "faces";
}

const std::string body = "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string plain =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\n" +
    body;

const std::vector<difference> differences{
    we_refuse("skips unknown header lines and versions, and extra words",
              some<&outline::lines>(is_odd_header_line), {"ascii 1.0", "ascii 2.0"}),
    we_refuse("permits repeated elements, properties and lines of ply or format", has_doubled_name,
              {"element vertex", "format ascii 1.0\nelement vertex"}),
    we_refuse("reads no values of properties of unknown types",
              [](std::string_view text) { return outline(text).has_odd_type; },
              {"float z\n", "float z\nproperty half w\n"}),
    we_refuse("permits elements without properties", some<&outline::elements>([](const element& e) {
                  return e.count > 0 && e.properties.empty();
              }),
              {"element face", "element nothing 5\nelement face"}),
    we_refuse("permits the names vertices and faces for vertex and face",
              some<&outline::elements>(has_plural_name), {"element vertex", "element vertices"}),
    we_refuse("reads absent coordinates as 0", some<&outline::elements>([](const element& e) {
                  return e.name == "vertex" && !(e.has("x") && e.has("y") && e.has("z"));
              }),
              {"float z", "float w"}),
    we_refuse("reads one of two lists of indices", some<&outline::elements>([](const element& e) {
                  return e.name == "face" && std::ranges::count_if(e.properties, is_index_list) > 1;
              }),
              {body,
               "property list uchar int vertex_index\nend_header\n"
               "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 3 0 1 2\n"}),
    we_refuse(
        "skips edges, strips and other elements with their indices",
        some<&outline::elements>([](const element& e) {
            return e.count > 0 && e.name != "vertex" && e.name != "face" &&
                   (e.name == "edge" || std::ranges::any_of(e.properties, is_index));
        }),
        {body, "element edge 1\nproperty int vertex1\nproperty int vertex2\n" + body + "7 7\n"}),
    we_refuse("permits an element on several lines, and several on one",
              [](std::string_view text) {
                  const outline o(text);
                  return o.is_ascii && !show_values(o, [](const auto&...) {});
              },
              {"0 0 0\n1 0 0", "0 0 0 1 0 0"}),
    we_refuse("reads integers that overflow modulo the size of their type",
              some_value([](const value& v) {
                  return v.declared.whole && is_integer(v.word) && !v.fits();
              }),
              {"3 0 1 2", "259 0 1 2"}),
    we_refuse("reads carriage returns, vertical tabs and form feeds as blanks",
              [](std::string_view text) { return text.find_first_of("\r\v\f") != text.npos; },
              {"0 0 0\n", "0 0 0\v\n"}),
    we_refuse("permits control characters in names", some<&outline::lines>([](const words& line) {
                  return !line.empty() && line[0] != "comment" && line[0] != "obj_info" &&
                         std::ranges::any_of(line, [](const std::string& word) {
                             return std::ranges::any_of(word, io::is_control);
                         });
              }),
              {"end_header", "element ed\x05 0\nend_header"}),
    peer_differs("requires the format in the second line",
                 [](std::string_view text) {
                     const outline o(text);
                     return o.lines.size() > 1 && !o.lines[1].empty() && o.lines[1][0] != "format";
                 },
                 {"ply\n", "ply\ncomment first\n"}),
    peer_differs("requires a list of indices of type int or uint, even without faces",
                 some<&outline::elements>([](const element& e) {
                     const auto list = std::ranges::find_if(e.properties, is_index_list);
                     return e.name == "face" &&
                            (list == e.properties.end() ||
                             (list->value->name != "int" && list->value->name != "uint"));
                 }),
                 {"uchar int", "uchar short"}),
    peer_differs(
        "requires floats or doubles as coordinates", some<&outline::elements>([](const element& e) {
            return e.name == "vertex" && std::ranges::any_of(e.properties, [](const property& p) {
                       return is_coordinate(p) && p.value->whole;
                   });
        }),
        {"float x", "short x"}),
    peer_differs("requires that skipped values have their types",
                 some_value([](const value& v) { return !v.is_used() && !v.fits(); }),
                 {body, "property int w\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 none\n"}),
    peer_differs("refuses integers with a point or an exponent", some_value([](const value& v) {
                     return v.is_used() && v.declared.whole && !is_integer(v.word);
                 }),
                 {"3 0 1 2", "3 0 1 2.0"}),
    peer_differs("permits the names vertices and faces for vertex and face",
                 some<&outline::elements>(has_plural_name),
                 {body, "element vertices 1\nproperty float x\n" + body + "0\n"}),
};

/// The text with line feeds in place of carriage returns without line feeds in the header.
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

const std::vector<rewriting> rewritings{
    {"does not know a byte order mark", without_byte_order_mark, {"ply", "\xef\xbb\xbfply"}},
    {"reads no carriage return without line feed as the end of a line",
     with_line_feeds,
     {plain,
      "ply\rformat ascii 1.0\relement vertex 3\rproperty float x\rproperty float y\r"
      "property float z\relement face 1\rproperty list uchar int vertex_indices\r"
      "end_header\r0 0 0\r1 0 0\r0 1 0\r3 0 1 2\r"}},
    {"reads only the 0 before the x of a hexadecimal number",
     [](std::string_view text) {
         return outline(text).is_ascii ? with_decimals(text) : std::string(text);
     },
     {"0 0 0", "0 0 0x1p-3"}},
};

/// True for a text that may crash or exhaust CGAL: one with a property of no element, many elements
/// without bytes, or long lists. (CGAL takes any second line for the format. After a value of
/// another type, the length of a list is random.)
bool harms_cgal(std::string_view text, bool is_read_by_us) {
    const outline o(text);
    const bool mistakes_line = o.lines.size() > 1 && !o.lines[1].empty() &&
                               (o.lines[1][0] == "element" || o.lines[1][0] == "end_header");
    const bool may_mistake_length =
        !is_read_by_us || some_value([](const value& v) { return !v.fits(); })(text);
    return o.has_stray_property || mistakes_line ||
           std::ranges::any_of(o.elements, [&](const element& e) {
               const bool may_be_long = std::ranges::any_of(e.properties, [](const property& p) {
                   return p.count && p.count->highest > 1e5;
               });
               return (e.properties.empty() && e.count > 1000) ||
                      (may_be_long && may_mistake_length);
           });
}

/// The mesh that CGAL reads, if it consists of triangles and the whole text was read.
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
    if (!test_meshes::is_sound(m)) return std::nullopt;
    return m;
}

/// Compares vertices bit for bit, and faces. CGAL skips edges.
outcome compare(std::string_view text, std::string_view given) {
    std::optional<mesh> ours = read_by(io::parse_mesh_ply, text);
    if (harms_cgal(given, ours.has_value())) return outcome::same;
    const std::optional<mesh> peers = read_by_cgal(given);
    if (!ours) return peers ? outcome::we_refuse : outcome::same;
    ours->edges.clear();
    return peers && test_meshes::same_mesh(*ours, *peers) ? outcome::same : outcome::peer_differs;
}

}  // namespace

const peer& the_peer() {
    static const peer cgal{
        compare,
        plain,
        rewritings,
        differences,
        test_meshes::texts(
            "ply|format|ascii|binary_little_endian|binary_big_endian|1.0|element|vertex|face|edge"
            "|list|char|uint8|short|ushort|int32|uint|float|double|x|property"
            "|vertex_index|property uchar red|end_header"),
        fuzz::spelled_ply};
    return cgal;
}

}  // namespace ccd::peers
