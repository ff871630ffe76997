// Files for ParaView: VTK's PolyData in XML with binary arrays, and PVD, which lists such files.
#include <algorithm>
#include <array>
#include <bit>
#include <ccd/contact.hpp>
#include <ccd/io/step_view.hpp>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <vector>

#include "ccd/io/view/view_files.hpp"

namespace ccd::io {
namespace {

using place = std::array<double, 3>;

/// The pairs in which a vertex, an edge or a face takes part.
class participation {
  public:
    /// The number of pairs, and the earliest time: NaN without pairs or times.
    struct share {
        std::uint32_t pairs = 0;
        double toi = std::numeric_limits<double>::quiet_NaN();

        void add(const share& other) {
            pairs += other.pairs;
            toi = std::fmin(toi, other.toi);  // prefers numbers to NaN
        }
    };

    explicit participation(const step_view& step) {
        for_each_kind([&]<kind K>() {
            const auto& times = step.times.of<K>();
            for (std::size_t i = 0; i < step.pairs.of<K>().size(); ++i) {
                const auto v = vertices_of(step.pairs.of<K>()[i]);
                const share one{1, times.empty() ? share{}.toi : times[i].low};
                constexpr std::size_t of_first = kind_traits<K>::first_vertices;
                elements_[key_of(std::span(v).template first<of_first>())].add(one);
                elements_[key_of(std::span(v).template subspan<of_first>())].add(one);
            }
        });
    }

    /// The share of a cell of at most three vertices: the sum over all elements whose vertices are
    /// among the cell's. No pair is counted twice, because its two elements share no vertex, and a
    /// cell has too few vertices for both.
    share of(std::span<const vertex_index> cell) const {
        const vertex_key all = key_of(cell);
        const auto last = std::ranges::find(all, all.back()) - all.begin();
        share sum;
        for (unsigned subset = 1; subset < 2u << last; ++subset) {
            vertex_key element;
            std::size_t size = 0;
            for (std::size_t i = 0; i < all.size(); ++i)
                if ((subset >> i & 1) != 0) element[size++] = all[i];
            if (const auto found = elements_.find(key_of(std::span(element).first(size)));
                found != elements_.end())
                sum.add(found->second);
        }
        return sum;
    }

  private:
    /// The vertices, ascending and each once; the last one fills the rest.
    using vertex_key = std::array<vertex_index, 3>;

    static vertex_key key_of(std::span<const vertex_index> vertices) {
        const vertex_index last = std::ranges::max(vertices);
        vertex_key key;
        key.fill(last);
        std::ranges::copy(vertices, key.begin());
        std::ranges::sort(key);
        std::fill(std::unique(key.begin(), key.end()), key.end(), last);
        return key;
    }

    std::map<vertex_key, share> elements_;
};

template <class Number>
constexpr std::string_view type_name() {
    if (std::is_same_v<Number, double>) return "Float64";
    if (std::is_same_v<Number, std::int64_t>) return "Int64";
    return std::is_same_v<Number, std::uint32_t> ? "UInt32" : "Int8";
}

template <class Items>
std::string_view bytes_of(const Items& items) {
    return {reinterpret_cast<const char*>(items.data()), items.size() * sizeof(*items.data())};
}

/// Appends an array: its size in bytes and its bytes. `more` are attributes, after a space.
template <class Number>
void append_array(std::string& text, std::string_view name, const std::vector<Number>& numbers,
                  std::string_view more = "") {
    text.append("<DataArray type=\"").append(type_name<Number>());
    text.append("\" Name=\"").append(name).append("\"").append(more).append(" format=\"binary\">");
    const std::array<std::uint64_t, 1> size{numbers.size() * sizeof(Number)};
    detail::append_base64(text, std::string(bytes_of(size)).append(bytes_of(numbers)));
    text += "</DataArray>\n";
}

void append_vectors(std::string& text, std::string_view name, const std::vector<place>& places) {
    std::vector<double> numbers;
    numbers.reserve(3 * places.size());
    for (const place& p : places) numbers.insert(numbers.end(), p.begin(), p.end());
    append_array(text, name, numbers, " NumberOfComponents=\"3\"");
}

/// The arrays of all cells, in the order of PolyData: vertices, lines, polygons.
struct cell_arrays {
    std::vector<std::uint32_t> pairs;
    std::vector<double> toi;
    std::vector<std::int64_t> pair;
    std::vector<std::int8_t> kind;

    void add(const participation::share& share, std::int64_t which, std::int8_t what) {
        pairs.push_back(share.pairs);
        toi.push_back(share.toi);
        pair.push_back(which);
        kind.push_back(what);
    }
};

class polydata {
  public:
    polydata(const step_view& step, frame shown)
        : step_(step), shown_(shown), shares_(step), displacements_(step.positions.vertices) {
        for (vertex_index v = 0; v < step.positions.vertices; ++v) {
            const auto [p, q] = step.positions[v];
            displacements_[v] = {q.x - p.x, q.y - p.y, q.z - p.z};
            const point<double>& here = shown == frame::before ? p : q;
            points_.push_back({here.x, here.y, here.z});
        }
        normals_.resize(points_.size());
        add_points();
        for_each_kind([&]<kind K>() { add_contacts<K>(); });
        for (const edge& e : step.edges) cells_.add(shares_.of(e), -1, -1);
        for (const face& f : step.faces) cells_.add(shares_.of(f), -1, -1);
    }

    std::string text() const {
        std::string text =
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
            "byte_order=\"";
        text += std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
        text += "\" header_type=\"UInt64\">\n<PolyData>\n<FieldData>\n";
        append_array(text, "TimeValue", std::vector<double>{shown_ == frame::before ? 0.0 : 1.0},
                     " NumberOfTuples=\"1\"");
        const auto count = [&text](std::string_view name, std::size_t number) {
            text.append(" ").append(name).append("=\"").append(std::to_string(number)) += '"';
        };
        text += "</FieldData>\n<Piece";
        count("NumberOfPoints", points_.size());
        count("NumberOfVerts", vertices_.size());
        count("NumberOfLines", step_.edges.size());
        count("NumberOfStrips", 0);
        count("NumberOfPolys", step_.faces.size());
        text += ">\n<PointData Vectors=\"displacement\">\n";
        append_vectors(text, "displacement", displacements_);
        append_vectors(text, "normal", normals_);
        text += "</PointData>\n<CellData Scalars=\"pairs\">\n";
        append_array(text, "pairs", cells_.pairs);
        append_array(text, "toi", cells_.toi);
        append_array(text, "pair", cells_.pair);
        append_array(text, "kind", cells_.kind);
        text += "</CellData>\n<Points>\n";
        append_vectors(text, "Points", points_);
        text += "</Points>\n";
        append_cells(text, "Verts", vertices_);
        append_cells(text, "Lines", step_.edges);
        append_cells(text, "Polys", step_.faces);
        return text + "</Piece>\n</PolyData>\n</VTKFile>\n";
    }

  private:
    void add_points() {
        std::vector<bool> on_edge(step_.positions.vertices);
        for (const face& f : step_.faces)
            for (const vertex_index v : f) on_edge[v] = true;
        for (const edge& e : step_.edges)
            for (const vertex_index v : e) on_edge[v] = true;
        for (vertex_index v = 0; v < step_.positions.vertices; ++v) {
            if (on_edge[v]) continue;
            vertices_.push_back({v});
            cells_.add(shares_.of({&v, 1}), -1, -1);
        }
    }

    template <kind K>
    void add_contacts() {
        const auto& pairs = step_.pairs.of<K>();
        const auto& times = step_.times.of<K>();
        std::vector<first_contact> contacts(pairs.size());
        if (!times.empty()) contacts = first_contacts(step_.positions, pairs, times);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const first_contact& contact = contacts[i];
            const double shown_at = shown_ == frame::before ? 0 : 1;
            vertices_.push_back({static_cast<std::int64_t>(points_.size())});
            points_.push_back(
                place_of<K>(pairs[i], contact, times.empty() ? shown_at : times[i].low));
            normals_.push_back({contact.normal.x, contact.normal.y, contact.normal.z});
            displacements_.push_back({});
            cells_.add({1, times.empty() ? std::numeric_limits<double>::quiet_NaN() : times[i].low},
                       number_of_contacts_++, static_cast<std::int8_t>(K));
        }
    }

    /// The contact point on the first element, or the middle of all vertices if the contact is
    /// unknown.
    template <kind K>
    place place_of(const pair_of_kind<K>& pair, const first_contact& contact, double t) const {
        const auto vertices = vertices_of(pair);
        const bool known = std::isfinite(contact.weight_error);
        const std::size_t count = known ? kind_traits<K>::first_vertices : vertices.size();
        place sum{};
        for (std::size_t i = 0; i < count; ++i) {
            const auto [p, q] = step_.positions[vertices[i]];
            const double weight = known ? contact.weights[i] : 1.0 / static_cast<double>(count);
            sum[0] += weight * ((1 - t) * p.x + t * q.x);
            sum[1] += weight * ((1 - t) * p.y + t * q.y);
            sum[2] += weight * ((1 - t) * p.z + t * q.z);
        }
        return sum;
    }

    template <class Cells>
    static void append_cells(std::string& text, std::string_view name, const Cells& cells) {
        std::vector<std::int64_t> connectivity, offsets;
        for (const auto& cell : cells) {
            connectivity.insert(connectivity.end(), cell.begin(), cell.end());
            offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
        }
        text.append("<").append(name).append(">\n");
        append_array(text, "connectivity", connectivity);
        append_array(text, "offsets", offsets);
        text.append("</").append(name).append(">\n");
    }

    const step_view& step_;
    frame shown_;
    participation shares_;
    std::vector<place> points_, displacements_, normals_;
    std::vector<std::array<std::int64_t, 1>> vertices_;
    cell_arrays cells_;
    std::int64_t number_of_contacts_ = 0;
};

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text)
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '"')
            out += "&quot;";
        else
            out += c;
    return out;
}

}  // namespace

std::string vtp_of(const step_view& step, frame shown) {
    detail::require_view(step);
    return polydata(step, shown).text();
}

std::string pvd_of(std::span<const series_entry> series) {
    std::string text =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n";
    for (const series_entry& entry : series) {
        if (!std::isfinite(entry.time))
            throw std::invalid_argument("time of '" + entry.file +
                                        "' is not finite; expected finite numbers");
        detail::require_xml_name(entry.file);
        char time[32];
        const auto end = std::to_chars(std::begin(time), std::end(time), entry.time).ptr;
        text.append("<DataSet timestep=\"").append(time, end).append("\" file=\"");
        text.append(escaped(entry.file)).append("\"/>\n");
    }
    return text + "</Collection>\n</VTKFile>\n";
}

}  // namespace ccd::io
