// Small meshes and many legal spellings of OBJ and PLY for them, chosen by bytes.
#include "tests/ccd/io/fuzz/spellings.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

#include "tests/ccd/io/meshes.hpp"

namespace ccd::fuzz {
namespace {

/// Choices by bytes, one after the other; zeros after the last.
class choices {
  public:
    choices(std::span<const std::uint8_t> bytes, dialect d)
        : bytes_(bytes), whole_(d == dialect::whole) {}

    unsigned below(unsigned end) {
        if (bytes_.empty()) return 0;
        const unsigned chosen = bytes_.front() % end;
        bytes_ = bytes_.subspan(1);
        return chosen;
    }
    /// One of the common texts or, in the whole format, one of the others.
    const char* one_of(std::initializer_list<const char*> common,
                       std::initializer_list<const char*> others = {}) {
        const auto size = static_cast<unsigned>(common.size());
        const unsigned i = below(size + (whole_ ? static_cast<unsigned>(others.size()) : 0));
        return i < size ? common.begin()[i] : others.begin()[i - size];
    }
    bool whole() const { return whole_; }
    /// A finite number; a float's value if `narrow`.
    double coordinate(bool narrow) {
        std::uint64_t bits = 0;
        for (int i = 0; i < 8; ++i) bits = bits << 8 | below(256);
        const double x = std::bit_cast<double>(bits);
        const double value = narrow ? static_cast<double>(static_cast<float>(x / 0x1p900)) : x;
        return std::isfinite(value) ? value : 0;
    }

  private:
    std::span<const std::uint8_t> bytes_;
    bool whole_;
};

mesh some_mesh(choices& choose, bool narrow) {
    mesh m;
    const unsigned vertices = 1 + choose.below(7);
    for (unsigned i = 0; i < vertices; ++i)
        m.vertices.push_back(
            {choose.coordinate(narrow), choose.coordinate(narrow), choose.coordinate(narrow)});
    const auto any = [&]() -> vertex_index { return choose.below(vertices); };
    for (unsigned faces = choose.below(5); faces > 0; --faces)
        m.faces.push_back({any(), any(), any()});
    for (unsigned edges = choose.below(3); edges > 0; --edges) m.edges.push_back({any(), any()});
    return m;
}

/// A spelling of x, as a float if `narrow`.
std::string spelled(choices& choose, double x, bool narrow) {
    std::array<char, 400> digits;
    const auto written = [&](auto... how) {
        const auto end =
            narrow ? std::to_chars(digits.begin(), digits.end(), static_cast<float>(x), how...)
                   : std::to_chars(digits.begin(), digits.end(), x, how...);
        return std::string(digits.begin(), end.ptr);
    };
    std::string text;
    switch (choose.below(choose.whole() ? 5 : 4)) {
        case 0:
            return written();
        case 1:
            text = written(std::chars_format::scientific);
            for (char& c : text) c = c == 'e' ? 'E' : c;
            return text;
        case 2:
            return written(std::chars_format::fixed);
        case 3:
            text = written();
            return std::signbit(x) ? text : "+" + text;
        default:
            text = written(std::chars_format::hex);
            return text.insert(text.starts_with('-') ? 1 : 0, choose.one_of({"0x", "0X", "0x000"}));
    }
}

/// The lines of an OBJ file, each with its own spelling.
class obj_writer {
  public:
    obj_writer(choices& choose, const ccd::mesh& m)
        : choose_(choose), mesh_(m), end_(choose.one_of({"\n", "\r\n", "\r"})) {}

    std::string text() {
        text_ = choose_.one_of({""}, {"\xef\xbb\xbf"});
        const bool faces_first = choose_.below(2) == 1;
        if (faces_first) add_elements(false);
        for (const auto& p : mesh_.vertices) {
            add("v");
            for (const double x : {p.x, p.y, p.z}) add(spelled(choose_, x, false));
            end_line(choose_.one_of({"", "1", "1.0", "0.5 0 1", "1 1 0 .5"}));
        }
        if (!faces_first) add_elements(true);
        return text_;
    }

  private:
    void add_elements(bool may_count_back) {
        const auto add_all = [&](const auto& elements, const char* keyword) {
            for (const auto& e : elements) {
                add(keyword);
                for (const vertex_index i : e) add(index(i, may_count_back));
                end_line("");
            }
        };
        add_all(mesh_.faces, choose_.one_of({"f"}, {"fo"}));
        add_all(mesh_.edges, "l");
    }

    std::string index(vertex_index i, bool may_count_back) {
        const auto vertices = static_cast<std::int64_t>(mesh_.vertices.size());
        const bool back = may_count_back && choose_.below(2) == 1;
        return std::to_string(back ? i - vertices : std::int64_t{i} + 1) +
               choose_.one_of({"", "/7", "//-1", "/1/1"}, {"/", "/1/"});
    }

    void add(const std::string& word) {
        text_ += word;
        text_ += choose_.one_of({" ", "\t"}, {"  "});
        if (choose_.whole() && choose_.below(16) == 1) text_ += "\\" + end_;
    }
    void end_line(const char* more) {
        text_ += more;
        text_ += choose_.one_of({"", " "}, {" # v 1 2 3", " #\xff\\"}) + end_;
        text_ += choose_.one_of({"", "", "", "# v 9 9 9", "\t", "o f 1 2 3", "vn 0 0 1"}, {"g a#"});
        if (text_.back() != end_.back()) text_ += end_;
    }

    choices& choose_;
    const ccd::mesh& mesh_;
    std::string end_, text_;
};

/// A PLY file of any format, types and order of elements, with other properties and elements.
class ply_writer {
  public:
    ply_writer(choices& choose, const ccd::mesh& m, bool narrow)
        : choose_(choose), mesh_(m), narrow_(narrow), format_(choose.below(3)) {}

    std::string text() {
        const char* const formats[] = {"ascii", "binary_little_endian", "binary_big_endian"};
        const char* const end = choose_.one_of({"\n", "\r\n"}, {"\r"});
        header_ = choose_.one_of({"ply\n"}, {"\xef\xbb\xbfply\n"});
        header_ += std::string("format ") + formats[format_] + " 1.0\n";
        const bool vertices_last = choose_.below(2) == 1;
        if (!vertices_last) add_vertices();
        header_ += choose_.one_of({"", "comment element face 9\n", "obj_info end_header\n"});
        add_faces();
        add_edges();
        if (vertices_last) add_vertices();
        return test_meshes::with_line_ends(header_ + "end_header\n", end) + body_;
    }

  private:
    template <class T>
    void add(T value, const std::string& spelling) {
        if (format_ == 0) {
            body_ += spelling + choose_.one_of({" ", "\t"});
            return;
        }
        std::array<char, sizeof(T)> bytes;
        std::memcpy(bytes.data(), &value, sizeof(T));
        if ((format_ == 1) != (std::endian::native == std::endian::little))
            std::reverse(bytes.begin(), bytes.end());
        body_.append(bytes.data(), bytes.size());
    }
    template <class T>
    void add(T whole) {
        add(whole, std::to_string(whole));
    }
    void end_element() {
        if (format_ == 0) body_ += choose_.one_of({"\n", "\r\n", "\n\n"});
    }

    void add_vertices() {
        const bool has_lists = choose_.below(2) == 1;
        const std::string type =
            narrow_ ? choose_.one_of({"float", "float32"}) : choose_.one_of({"double", "float64"});
        header_ += "element vertex " + std::to_string(mesh_.vertices.size()) + "\n";
        for (const char* axis : {"x", "y", "z"})
            header_ += "property " + type + " " + axis + "\n" +
                       (has_lists ? std::string("property list uint8 short n") + axis + "\n" : "");
        for (const auto& p : mesh_.vertices) {
            for (const double x : {p.x, p.y, p.z}) {
                const std::string spelling = spelled(choose_, x, narrow_);
                if (narrow_)
                    add(static_cast<float>(x), spelling);
                else
                    add(x, spelling);
                if (has_lists) add(std::uint8_t{1}), add(std::int16_t{-7});
            }
            end_element();
        }
    }

    void add_faces() {
        const std::string type =
            choose_.one_of({"int", "uint32", "uint"}, {"ushort", "char", "int16", "uint16"});
        const std::string count = choose_.one_of({"uchar", "int8", "int"});
        header_ += "element face " + std::to_string(mesh_.faces.size()) + "\nproperty list " +
                   count + " " + type + " " + choose_.one_of({"vertex_indices", "vertex_index"}) +
                   "\n";
        for (const auto& f : mesh_.faces) {
            if (count == "int")
                add(std::int32_t{3});
            else
                add(std::uint8_t{3});
            for (const vertex_index i : f) {
                if (type == "char")
                    add(static_cast<std::int8_t>(i));
                else if (type == "ushort" || type.ends_with("16"))
                    add(static_cast<std::uint16_t>(i));
                else
                    add(i);
            }
            end_element();
        }
    }

    void add_edges() {
        header_ += "element edge " + std::to_string(mesh_.edges.size()) +
                   "\nproperty int vertex1\nproperty double weight\nproperty uchar vertex2\n";
        for (const auto& e : mesh_.edges) {
            add(static_cast<std::int32_t>(e[0]));
            add(0.5, "0.5");
            add(static_cast<std::uint8_t>(e[1]));
            end_element();
        }
    }

    choices& choose_;
    const ccd::mesh& mesh_;
    bool narrow_;
    unsigned format_;
    std::string header_, body_;
};

}  // namespace

spelling spelled_obj(std::span<const std::uint8_t> bytes, dialect d) {
    choices choose(bytes, d);
    const mesh m = some_mesh(choose, d == dialect::common);
    return {m, obj_writer(choose, m).text()};
}

spelling spelled_ply(std::span<const std::uint8_t> bytes, dialect d) {
    choices choose(bytes, d);
    const bool narrow = choose.below(2) == 1;
    const mesh m = some_mesh(choose, narrow);
    return {m, ply_writer(choose, m, narrow).text()};
}

}  // namespace ccd::fuzz
