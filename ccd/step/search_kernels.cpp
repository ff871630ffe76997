// Kernels for trees of extents: see ccd/batch/batch_kernels.hpp for the rules of this file.
#include "ccd/step/search_kernels.hpp"

#include <cstdint>
#include <limits>

#include "ccd/batch/rounded_positions.hpp"
#include "ccd/batch/row_quads.hpp"
#include "ccd/exact/simd.hpp"
#include "ccd/step/rest/triangle_signs.hpp"

namespace ccd::detail::ERRBOUND_INSTRUCTION_SET {
namespace {

using float_pack = pack_of<float>;
constexpr std::size_t float_width = float_pack::size;
constexpr std::size_t size = extents_column::size, columns_of_end = extents::columns_of_end;
static_assert(size % float_width == 0);

/// Even columns hold least values, odd ones the most.
constexpr bool is_most(std::size_t column) {
    return (column & 1) != 0;
}
constexpr std::size_t lesser(std::size_t a, std::size_t b) {
    return a < b ? a : b;
}
constexpr float infinity = std::numeric_limits<float>::infinity();

/// Coordinates of a pack's elements: by vertex, end of the step, axis.
template <std::size_t N>
struct corner_columns {
    alignas(64) float at[N][2][3][size];

    corner_columns(const float* rounded, const vertex_index* elements, std::size_t first,
                   std::size_t count, std::size_t ends) {
        for (std::size_t v = 0; v < N; ++v)
            for (std::size_t lane = 0; lane < size; lane += 4) {
                const float* rows[4];
                for (std::size_t i = 0; i < 4; ++i) {
                    const std::size_t element = first + lane + i;
                    rows[i] =
                        rounded + rounded_positions::row *
                                      elements[N * (element < count ? element : count - 1) + v];
                }
                for (std::size_t end = 0; end < ends; ++end)
                    for (std::size_t k = 0; const float_quad& q : row_quads(rows, end).axis)
                        __builtin_memcpy(&at[v][end][k++][lane], &q, sizeof(q));
            }
    }
};

/// Sets the columns of one axis at one end of the step. values(v) are those of vertex v.
template <std::size_t N, class Values>
void set_extent(extents_column* of_axis, std::size_t lane, float margin, const Values& values) {
    float_pack least = values(0), most = least;
    for (std::size_t v = 1; v < N; ++v) {
        least = min(least, values(v));
        most = max(most, values(v));
    }
    (least - float_pack(margin)).store_aligned(&of_axis[0].at[lane]);
    (most + float_pack(margin)).store_aligned(&of_axis[1].at[lane]);
}

/// Widens an axis' columns at the start by those at the end. Proof: proofs/filters/Extents.v,
/// swept_extents_hold.
inline void sweep_extent(extents_column* of_axis, std::size_t lane) {
    const auto column = [&](std::size_t c) { return &of_axis[c].at[lane]; };
    const auto load = [&](std::size_t c) { return float_pack::load_aligned(column(c)); };
    min(load(0), load(columns_of_end)).store_aligned(column(0));
    max(load(1), load(columns_of_end + 1)).store_aligned(column(1));
}

inline float_quad extreme(const float_quad& x, const float_quad& y, bool most) {
    return most ? (x < y ? y : x) : (x < y ? x : y);
}
inline float extreme(const float (&column)[size], bool most) {
    float_quad x;
    __builtin_memcpy(&x, column, sizeof(x));
    for (std::size_t i = 4; i < size; i += 4) {
        float_quad y;
        __builtin_memcpy(&y, &column[i], sizeof(y));
        x = extreme(x, y, most);
    }
    x = extreme(x, chosen<2, 3, 0, 1>(x, x), most);
    x = extreme(x, chosen<1, 0, 3, 2>(x, x), most);
    return x[0];
}

inline void set_hull(float* hull, const extents_column* packed, std::size_t columns) {
    for (std::size_t c = 0; c < columns; ++c) hull[c] = extreme(packed[c].at, is_most(c));
}

inline void set_nowhere(extents_column* packed, std::size_t columns, std::size_t from) {
    for (std::size_t c = 0; c < columns; ++c)
        for (std::size_t i = from; i < size; ++i)
            packed[c].at[i] = is_most(c) ? -infinity : infinity;
}

template <std::size_t N>
void fill_leaves(const float* rounded, float margin, bool swept, const vertex_index* elements,
                 std::size_t count, std::size_t first, std::size_t end_leaf, std::size_t columns,
                 extents_column* leaves, float* hulls, leaf_vertices* vertices) {
    const float margin_across = extents::margin + 2 * margin;
    const std::size_t ends = columns / columns_of_end;
    for (std::size_t p = first; p < end_leaf; ++p) {
        extents_column* const leaf = leaves + columns * p;
        const corner_columns<N> corners(rounded, elements, size * p, count, ends);
        for (std::size_t end = 0; end < ends; ++end)
            for (std::size_t lane = 0; lane < size; lane += float_width)
                for (std::size_t k = 0; k < 3; ++k) {
                    const auto x = [&](std::size_t v) {
                        return float_pack::load_aligned(&corners.at[v][end][k][lane]);
                    };
                    const auto y = [&](std::size_t v) {
                        return float_pack::load_aligned(&corners.at[v][end][(k + 1) % 3][lane]);
                    };
                    extents_column* const at_end = leaf + columns_of_end * end;
                    set_extent<N>(at_end + 2 * k, lane, margin, x);
                    set_extent<N>(at_end + 6 + 4 * k, lane, margin_across,
                                  [&](std::size_t v) { return x(v) + y(v); });
                    set_extent<N>(at_end + 8 + 4 * k, lane, margin_across,
                                  [&](std::size_t v) { return x(v) - y(v); });
                }
        for (std::size_t axis = 0; swept && axis < extents::axes; ++axis)
            for (std::size_t lane = 0; lane < size; lane += float_width)
                sweep_extent(leaf + 2 * axis, lane);
        if (count < size * (p + 1)) set_nowhere(leaf, columns, count - size * p);
        set_hull(hulls + columns * p, leaf, columns);
        for (std::size_t i = 0; i < size; ++i)
            for (std::size_t v = 0; v < N; ++v)
                vertices[p].at[v][i] = elements[N * lesser(size * p + i, count - 1) + v];
    }
}

void fill_nodes(const float* below, std::size_t count, std::size_t first, std::size_t end,
                std::size_t columns, extents_column* packs, float* hulls) {
    for (std::size_t p = first; p < end; ++p) {
        extents_column* const node = packs + columns * p;
        const std::size_t members = lesser(count - size * p, size);
        for (std::size_t i = 0; i < members; ++i)
            for (std::size_t c = 0; c < columns; ++c)
                node[c].at[i] = below[columns * (size * p + i) + c];
        set_nowhere(node, columns, members);
        set_hull(hulls + columns * p, node, columns);
    }
}

struct hull_reader {
    const float* of;
    float operator()(std::size_t column) const { return of[column]; }
};
struct member_reader {
    const extents_column* pack;
    std::size_t member;
    float operator()(std::size_t column) const { return pack[column].at[member]; }
};

/// The times at which an axis must separate elements.
enum class times : bool { whole_step, start };

/// The lanes that no axis separates from `other`. Coordinate axes separate most, so the others are
/// tested only if lanes remain.
template <times At, class Extents>
lanes touching(const extents_column* packed, const Extents& other) {
    constexpr std::size_t parts = size / float_width;
    mask_of<float> apart[parts] = {};
    const auto separate = [&](std::size_t a) {
        for (std::size_t part = 0; part < parts; ++part) {
            const auto below = [&](std::size_t c) {
                return float_pack::load_aligned(&packed[c + 1].at[float_width * part]) <
                       float_pack(other(c));
            };
            const auto above = [&](std::size_t c) {
                return float_pack::load_aligned(&packed[c].at[float_width * part]) >
                       float_pack(other(c + 1));
            };
            const std::size_t start = 2 * a, end = start + columns_of_end;
            if constexpr (At == times::start)
                apart[part] = apart[part] | below(start) | above(start);
            else
                apart[part] =
                    apart[part] | (below(start) & below(end)) | (above(start) & above(end));
        }
    };
    const auto all_apart = [&] {
        mask_of<float> both = apart[0];
        for (std::size_t part = 1; part < parts; ++part) both = both & apart[part];
        return all(both);
    };
    for (std::size_t a = 0; a < 3; ++a) separate(a);
    if (all_apart()) return 0;
    for (std::size_t a = 3; a < extents::axes; ++a) separate(a);
    lanes found = 0;
    for (std::size_t part = 0; part < parts; ++part)
        found |= (~lanes_of<float>(apart[part]) & first_lanes(float_width)) << float_width * part;
    return found;
}

typedef vertex_index index_pack __attribute__((vector_size(4 * size)));
typedef vertex_index index_quad __attribute__((vector_size(16)));

/// The lanes of `leaf` that share a vertex with element i of `other`.
template <std::size_t N, std::size_t M>
lanes sharing(const leaf_vertices& leaf, const leaf_vertices& other, std::uint32_t i) {
    index_pack same{};
    for (std::size_t w = 0; w < M; ++w) {
        index_pack vertices;
        __builtin_memcpy(&vertices, leaf.at[w], sizeof(vertices));
        for (std::size_t v = 0; v < N; ++v)
            same |= index_pack(vertices == index_pack{} + other.at[v][i]);
    }
    same &= index_pack{1,      1 << 1, 1 << 2,  1 << 3,  1 << 4,  1 << 5,  1 << 6,  1 << 7,
                       1 << 8, 1 << 9, 1 << 10, 1 << 11, 1 << 12, 1 << 13, 1 << 14, 1 << 15};
    index_quad quads[size / 4];
    __builtin_memcpy(quads, &same, sizeof(quads));
    const index_quad found = (quads[0] | quads[1]) | (quads[2] | quads[3]);
    return found[0] | found[1] | found[2] | found[3];
}

struct found_pairs {
    static constexpr std::size_t room = 512;

    void* context;
    search_kernels::visitor visit;
    std::size_t count = 0;
    element_pair pairs[room];

    found_pairs(void* to, search_kernels::visitor by) : context(to), visit(by) {}
    /// Makes room for the pairs of one comparison.
    void make_room() {
        if (count + size > room) flush();
    }
    void add(std::size_t first, std::size_t second) {
        pairs[count++] = {static_cast<unsigned>(first), static_cast<unsigned>(second)};
    }
    void flush() {
        visit(context, pairs, count);
        count = 0;
    }
};

/// Finds pairs of leaf p of `a`, with elements of N vertices, and leaf q of `b`, of M vertices. In
/// one tree, the element of `b` is the later one.
template <std::size_t N, std::size_t M, times At>
void pairs_of_leaves(const extents_levels& a, std::size_t p, const extents_levels& b, std::size_t q,
                     found_pairs& found) {
    const extents_column *leaf = a.pack(0, p), *other = b.pack(0, q);
    const bool is_same = &a == &b && p == q;
    const lanes of_other = touching<At>(other, hull_reader{a.hull(0, p)});
    if (of_other == 0) return;
    const lanes of_leaf = touching<At>(leaf, hull_reader{b.hull(0, q)});
    if (count_of(of_leaf) <= count_of(of_other))
        for_each_lane(of_leaf, [&](std::uint32_t i) {
            lanes some = touching<At>(other, member_reader{leaf, i}) & of_other;
            if (is_same) some &= ~first_lanes(i + 1);
            if (some == 0) return;
            some &= ~sharing<N, M>(b.vertices[q], a.vertices[p], i);
            found.make_room();
            for_each_lane(some, [&](std::uint32_t j) { found.add(size * p + i, size * q + j); });
        });
    else
        for_each_lane(of_other, [&](std::uint32_t j) {
            lanes some = touching<At>(leaf, member_reader{other, j}) & of_leaf;
            if (is_same) some &= first_lanes(j);
            if (some == 0) return;
            some &= ~sharing<M, N>(a.vertices[p], b.vertices[q], j);
            found.make_room();
            for_each_lane(some, [&](std::uint32_t i) { found.add(size * p + i, size * q + j); });
        });
}

template <std::size_t N, std::size_t M, times At>
void find_pairs(const extents_levels& a, const extents_levels& b, std::size_t first,
                std::size_t end, void* context, search_kernels::visitor visit) {
    struct node {
        std::size_t level, position;
    };
    node open[size * extents_levels::most];
    found_pairs found(context, visit);
    // Leaves with one parent share the nodes above those that hold leaves.
    for (std::size_t next = first; next < end;) {
        const std::size_t from = next, parent = from / size;
        next = lesser(end, size * (parent + 1));
        const hull_reader hull{a.count > 1 ? a.hull(1, parent) : a.hull(0, 0)};
        std::size_t opened = 0;
        open[opened++] = {b.count - 1, 0};
        while (opened > 0) {
            const node n = open[--opened];
            const extents_column* const children = b.pack(n.level, n.position);
            if (n.level > 1) {
                const std::size_t least = &a == &b ? from >> (4 * (n.level - 1)) : 0;
                for_each_lane(touching<At>(children, hull), [&](std::uint32_t i) {
                    const std::size_t child = size * n.position + i;
                    if (child >= least) open[opened++] = {n.level - 1, child};
                });
                continue;
            }
            for (std::size_t p = from; p < next; ++p) {
                if (n.level == 0) {
                    pairs_of_leaves<N, M, At>(a, p, b, n.position, found);
                    continue;
                }
                const std::size_t least = &a == &b ? p : 0;
                for_each_lane(touching<At>(children, hull_reader{a.hull(0, p)}),
                              [&](std::uint32_t i) {
                                  const std::size_t q = size * n.position + i;
                                  if (q >= least) pairs_of_leaves<N, M, At>(a, p, b, q, found);
                              });
            }
        }
    }
    found.flush();
}

}  // namespace

constinit const search_kernels searching = {fill_leaves<1>,
                                            fill_leaves<2>,
                                            fill_leaves<3>,
                                            fill_nodes,
                                            find_pairs<1, 3, times::whole_step>,
                                            find_pairs<2, 2, times::whole_step>,
                                            find_pairs<1, 3, times::start>,
                                            find_pairs<2, 2, times::start>,
                                            find_pairs<3, 3, times::start>,
                                            triangle_signs<element_pair>};

}  // namespace ccd::detail::ERRBOUND_INSTRUCTION_SET
