#include "tests/bench/scenes.hpp"

#include <algorithm>
#include <array>
#include <ccd/io/mesh_file.hpp>
#include <ccd/io/query_file.hpp>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "tests/support/query_families.hpp"

namespace bench {
namespace {

namespace fs = std::filesystem;

fs::path data_folder() {
    const char* folder = std::getenv("ERRBOUND_SHARED_DATA");
    return folder != nullptr ? folder : ERRBOUND_SHARED_DATA;
}

// ---- Candidates ----

struct box {
    std::array<double, 3> low, high;
    std::uint32_t element;
};

bool touch(const box& a, const box& b) {
    for (std::size_t k = 0; k < 3; ++k) {
        if (a.low[k] > b.high[k] || b.low[k] > a.high[k]) return false;
    }
    return true;
}

template <std::size_t N>
box swept_box(const ccd::mesh& before, const ccd::mesh& after,
              const std::array<ccd::vertex_index, N>& vertices, std::size_t element) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    box b{{infinity, infinity, infinity},
          {-infinity, -infinity, -infinity},
          static_cast<std::uint32_t>(element)};
    for (const ccd::vertex_index v : vertices) {
        for (const ccd::mesh* frame : {&before, &after}) {
            const auto& p = frame->vertices[v];
            const std::array<double, 3> x{p.x, p.y, p.z};
            for (std::size_t k = 0; k < 3; ++k) {
                b.low[k] = std::min(b.low[k], x[k]);
                b.high[k] = std::max(b.high[k], x[k]);
            }
        }
    }
    return b;
}

/// Boxes by the uniform grid's cells that they touch: (cell, box), sorted by cell.
struct cell_entry {
    std::uint64_t cell;
    std::uint32_t box;
    friend auto operator<=>(const cell_entry&, const cell_entry&) = default;
};

/// A uniform grid with cells twice as wide as the boxes are on average.
class box_grid {
  public:
    explicit box_grid(const std::vector<box>& boxes) {
        low_ = boxes.front().low;
        for (const box& b : boxes) {
            for (std::size_t k = 0; k < 3; ++k) {
                low_[k] = std::min(low_[k], b.low[k]);
                width_ += 2 * (b.high[k] - b.low[k]) / (3 * static_cast<double>(boxes.size()));
            }
        }
    }
    using cell = std::array<std::uint64_t, 3>;
    cell cell_of(const std::array<double, 3>& x) const {
        cell c{};
        for (std::size_t k = 0; k < 3; ++k) {
            c[k] = static_cast<std::uint64_t>((x[k] - low_[k]) / width_);
        }
        return c;
    }
    static std::uint64_t key(const cell& c) { return (c[0] << 42) | (c[1] << 21) | c[2]; }

    std::vector<cell_entry> entries(const std::vector<box>& boxes) const {
        std::vector<cell_entry> all;
        for (std::uint32_t i = 0; i < boxes.size(); ++i) {
            const cell from = cell_of(boxes[i].low), to = cell_of(boxes[i].high);
            cell c;
            for (c[0] = from[0]; c[0] <= to[0]; ++c[0]) {
                for (c[1] = from[1]; c[1] <= to[1]; ++c[1]) {
                    for (c[2] = from[2]; c[2] <= to[2]; ++c[2]) all.push_back({key(c), i});
                }
            }
        }
        std::ranges::sort(all);
        return all;
    }

  private:
    std::array<double, 3> low_{};
    double width_ = 0;
};

/// Calls found(a, b) once for every pair of touching boxes of the two lists; of one list with
/// itself, once for either order and also for a box with itself.
template <class Found>
void touching_pairs(const std::vector<box>& as, const std::vector<box>& bs, const Found& found) {
    if (as.empty() || bs.empty()) return;
    std::vector<box> all = as;
    all.insert(all.end(), bs.begin(), bs.end());
    const box_grid grid(all);
    const std::vector<cell_entry> a_cells = grid.entries(as), b_cells = grid.entries(bs);
    auto b_begin = b_cells.begin();
    for (auto a = a_cells.begin(); a != a_cells.end(); ++a) {
        while (b_begin != b_cells.end() && b_begin->cell < a->cell) ++b_begin;
        for (auto b = b_begin; b != b_cells.end() && b->cell == a->cell; ++b) {
            const box &p = as[a->box], &q = bs[b->box];
            if (!touch(p, q)) continue;
            // Boxes that meet in several cells are found in the lowest of them.
            std::array<double, 3> lowest{};
            for (std::size_t k = 0; k < 3; ++k) lowest[k] = std::max(p.low[k], q.low[k]);
            if (box_grid::key(grid.cell_of(lowest)) == a->cell) found(p.element, q.element);
        }
    }
}

// ---- Stored and made queries ----

/// All query files under the folder; false if there is none.
bool read_stored(const fs::path& folder, query_sets& queries) {
    if (!fs::is_directory(folder)) return false;
    std::vector<fs::path> paths;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.path().extension() == ".csv") paths.push_back(entry.path());
    }
    std::ranges::sort(paths);
    for (const fs::path& path : paths) {
        const auto file = ccd::io::read_queries(path, std::nullopt, false);
        std::visit(
            [&queries]<class Query>(const std::vector<Query>& read) {
                auto& all = queries.of<ccd::kind_of<Query>>().stored;
                all.insert(all.end(), read.begin(), read.end());
            },
            file.queries);
    }
    return !paths.empty();
}

/// Queries on small integer grids, most of them degenerate.
void make_degenerate(query_sets& queries) {
    constexpr std::uint64_t of_each_family = 2000;
    const std::uint64_t seed = 1;
    for (const auto& family : query_families::families) {
        if (family.name.find("grid") == std::string_view::npos ||
            family.name.find('^') != std::string_view::npos) {
            continue;
        }
        queries.for_each([&]<class Query>(ccd::report::query_set<Query>& into) {
            for (std::uint64_t i = 0; i < of_each_family; ++i)
                into.stored.push_back(query_families::as_query<Query>(
                    query_families::make(family, ccd::kind_of<Query>, seed, i)));
        });
    }
}

struct frame_files {
    fs::path before, after;
};

std::optional<frame_files> frames_of(const std::string& name) {
    if (name == "cloth-over-ball") {
        const fs::path folder = fs::path(ERRBOUND_SCENES) / "cloth-over-ball";
        return frame_files{folder / "frame0.ply", folder / "frame1.ply"};
    }
    const fs::path folder = data_folder() / "scenes" / name / "frames";
    if (name == "cloth-funnel") return frame_files{folder / "227.ply", folder / "228.ply"};
    if (name == "cloth-ball") {
        return frame_files{folder / "cloth_ball92.ply", folder / "cloth_ball93.ply"};
    }
    return std::nullopt;
}

}  // namespace

query_sets candidates(const ccd::mesh& before, const ccd::mesh& after) {
    const auto boxes_of = [&](const auto& elements) {
        std::vector<box> boxes;
        for (std::size_t i = 0; i < elements.size(); ++i) {
            boxes.push_back(swept_box(before, after, elements[i], i));
        }
        return boxes;
    };
    std::vector<std::array<ccd::vertex_index, 1>> vertices(before.vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i)
        vertices[i] = {static_cast<ccd::vertex_index>(i)};
    const auto edges = ccd::unique_edges(before.faces);
    const std::vector<box> edge_boxes = boxes_of(edges);

    query_sets result;
    result.vertex_face.rows = result.edge_edge.rows = ccd::vertex_rows(before, after);
    auto& vf = result.vertex_face.by_index;
    auto& ee = result.edge_edge.by_index;
    touching_pairs(boxes_of(vertices), boxes_of(before.faces),
                   [&](ccd::vertex_index v, ccd::vertex_index f) {
                       const ccd::face& t = before.faces[f];
                       if (std::ranges::find(t, v) == t.end()) vf.push_back({v, t[0], t[1], t[2]});
                   });
    touching_pairs(edge_boxes, edge_boxes, [&](ccd::vertex_index i, ccd::vertex_index j) {
        const ccd::edge &a = edges[i], &b = edges[j];
        if (i < j && a[0] != b[0] && a[0] != b[1] && a[1] != b[0] && a[1] != b[1]) {
            ee.push_back({a[0], a[1], b[0], b[1]});
        }
    });
    std::ranges::sort(vf, {}, [](const auto& q) { return std::array{q.v, q.f0, q.f1, q.f2}; });
    std::ranges::sort(ee, {}, [](const auto& q) { return std::array{q.a0, q.a1, q.b0, q.b1}; });
    return result;
}

std::vector<std::string> scene_names() {
    return {"cloth-over-ball", "cloth-funnel", "cloth-ball", "handcrafted", "degenerate"};
}

bool load(const std::string& name, scene& into) {
    into.name = name;
    if (name == "handcrafted") return read_stored(data_folder() / "queries", into.queries);
    if (name == "degenerate") {
        make_degenerate(into.queries);
        return true;
    }
    const auto files = frames_of(name);
    if (!files || !fs::exists(files->before) || !fs::exists(files->after)) return false;
    into.before = ccd::io::read_mesh(files->before);
    into.after = ccd::io::read_mesh(files->after);
    into.queries = candidates(into.before, into.after);
    return true;
}

void make_cloth_over_sphere(int n, ccd::mesh& before, ccd::mesh& after) {
    const double cell = 2.0 / (n - 1);
    constexpr double radius = 0.5;
    query_families::source random(1);
    before = after = {};
    const auto add = [&](double x, double y, double z, double sink) {
        before.vertices.push_back({x, y, z});
        after.vertices.push_back({x, y, z - sink});
        return static_cast<ccd::vertex_index>(before.vertices.size() - 1);
    };
    const auto add_grid = [&](int rows, int columns, const auto& vertex) {
        for (int i = 0; i < rows; ++i) {
            for (int j = 0; j < columns; ++j) vertex(i, j);
        }
        const auto first = before.vertices.size() -
                           static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
        const auto at = [&](int i, int j) {
            return static_cast<ccd::vertex_index>(first) +
                   static_cast<ccd::vertex_index>(i * columns + j);
        };
        for (int i = 0; i + 1 < rows; ++i) {
            for (int j = 0; j + 1 < columns; ++j) {
                before.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
                before.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
            }
        }
    };
    add_grid(n, n, [&](int i, int j) {
        const double x = cell * i - 1, y = cell * j - 1;
        const double r = std::hypot(x, y);
        // On the sphere's cap, and on by the tangent cone.
        const double outer = radius + 0.4 * cell, rim = 0.7 * radius;
        const double rim_height = std::sqrt(outer * outer - rim * rim);
        const double z =
            r <= rim ? std::sqrt(outer * outer - r * r) : rim_height - (r - rim) * rim / rim_height;
        add(x, y, z + 0.2 * cell * random.symmetric(), cell * (0.5 + 0.2 * random.symmetric()));
    });
    // The upper half of the sphere, as a grid bent onto it.
    add_grid(n / 2, n / 2, [&](int i, int j) {
        const double u = 4.0 * i / (n / 2 - 1) - 2, v = 4.0 * j / (n / 2 - 1) - 2;
        const double length = std::sqrt(u * u + v * v + 1);
        add(radius * u / length, radius * v / length, radius / length, 0);
    });
    after.faces = before.faces;
}

}  // namespace bench
