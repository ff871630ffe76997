// Kernels for trees of extents: see ccd/batch/batch_kernels.hpp for the rules of this file.
#include "ccd/step/search_kernels.hpp"

#include <cstdint>
#include <limits>

#include "ccd/batch/rounded_positions.hpp"
#include "ccd/batch/row_quads.hpp"
#include "ccd/exact/simd.hpp"

namespace ccd::detail::ERRBOUND_INSTRUCTION_SET {
namespace {

using float_pack = pack_of<float>;
constexpr std::size_t float_width = float_pack::size;
constexpr std::size_t size = extents_pack::size, columns = extents::columns;
static_assert(size % float_width == 0);

/// Columns 4a and 4a + 1 hold least values, 4a + 2 and 4a + 3 the most.
constexpr bool is_most(std::size_t column) {
    return (column & 2) != 0;
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
                   std::size_t count) {
        for (std::size_t v = 0; v < N; ++v)
            for (std::size_t lane = 0; lane < size; lane += 4) {
                const float* rows[4];
                for (std::size_t i = 0; i < 4; ++i) {
                    const std::size_t element = first + lane + i;
                    rows[i] =
                        rounded + rounded_positions::row *
                                      elements[N * (element < count ? element : count - 1) + v];
                }
                for (std::size_t end = 0; end < 2; ++end)
                    for (std::size_t k = 0; const float_quad& q : row_quads(rows, end).axis)
                        __builtin_memcpy(&at[v][end][k++][lane], &q, sizeof(q));
            }
    }
};

/// Sets one axis' columns at one end of the step. values(v) are those of vertex v.
template <std::size_t N, class Values>
void set_extent(extents_pack& packed, std::size_t axis, std::size_t end, std::size_t lane,
                float margin, const Values& values) {
    float_pack least = values(0), most = least;
    for (std::size_t v = 1; v < N; ++v) {
        least = min(least, values(v));
        most = max(most, values(v));
    }
    (least - float_pack(margin)).store_aligned(&packed.at[4 * axis + end][lane]);
    (most + float_pack(margin)).store_aligned(&packed.at[4 * axis + 2 + end][lane]);
}

/// Widens an axis' columns at the start by those at the end. Proof: proofs/Extents.v,
/// swept_extents_hold.
inline void sweep_extent(extents_pack& packed, std::size_t axis, std::size_t lane) {
    const auto column = [&](std::size_t c) { return &packed.at[4 * axis + c][lane]; };
    const auto load = [&](std::size_t c) { return float_pack::load_aligned(column(c)); };
    min(load(0), load(1)).store_aligned(column(0));
    max(load(2), load(3)).store_aligned(column(2));
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

inline extents hull_of(const extents_pack& packed) {
    extents e;
    for (std::size_t c = 0; c < columns; ++c) e.of[c] = extreme(packed.at[c], is_most(c));
    return e;
}

inline void set_nowhere(extents_pack& packed, std::size_t from) {
    for (std::size_t c = 0; c < columns; ++c)
        for (std::size_t i = from; i < size; ++i)
            packed.at[c][i] = is_most(c) ? -infinity : infinity;
}

template <std::size_t N>
void fill_leaves(const float* rounded, float margin, bool swept, const vertex_index* elements,
                 std::size_t count, std::size_t first, std::size_t end_leaf, extents_pack* leaves,
                 extents* hulls, leaf_vertices* vertices) {
    const float margin_across = extents::margin + 2 * margin;
    for (std::size_t p = first; p < end_leaf; ++p) {
        const corner_columns<N> corners(rounded, elements, size * p, count);
        for (std::size_t end = 0; end < 2; ++end)
            for (std::size_t lane = 0; lane < size; lane += float_width)
                for (std::size_t k = 0; k < 3; ++k) {
                    const auto x = [&](std::size_t v) {
                        return float_pack::load_aligned(&corners.at[v][end][k][lane]);
                    };
                    const auto y = [&](std::size_t v) {
                        return float_pack::load_aligned(&corners.at[v][end][(k + 1) % 3][lane]);
                    };
                    set_extent<N>(leaves[p], k, end, lane, margin, x);
                    set_extent<N>(leaves[p], 3 + 2 * k, end, lane, margin_across,
                                  [&](std::size_t v) { return x(v) + y(v); });
                    set_extent<N>(leaves[p], 4 + 2 * k, end, lane, margin_across,
                                  [&](std::size_t v) { return x(v) - y(v); });
                }
        for (std::size_t axis = 0; swept && axis < extents::axes; ++axis)
            for (std::size_t lane = 0; lane < size; lane += float_width)
                sweep_extent(leaves[p], axis, lane);
        if (count < size * (p + 1)) set_nowhere(leaves[p], count - size * p);
        hulls[p] = hull_of(leaves[p]);
        for (std::size_t i = 0; i < size; ++i)
            for (std::size_t v = 0; v < N; ++v)
                vertices[p].at[v][i] = elements[N * lesser(size * p + i, count - 1) + v];
    }
}

void fill_nodes(const extents* below, std::size_t count, std::size_t first, std::size_t end,
                extents_pack* packs, extents* hulls) {
    for (std::size_t p = first; p < end; ++p) {
        const std::size_t members = lesser(count - size * p, size);
        for (std::size_t i = 0; i < members; ++i)
            for (std::size_t c = 0; c < columns; ++c) packs[p].at[c][i] = below[size * p + i].of[c];
        set_nowhere(packs[p], members);
        hulls[p] = hull_of(packs[p]);
    }
}

struct hull_reader {
    const extents& of;
    float operator()(std::size_t column) const { return of.of[column]; }
};
struct member_reader {
    const extents_pack& pack;
    std::size_t member;
    float operator()(std::size_t column) const { return pack.at[column][member]; }
};

/// The times at which an axis must separate elements.
enum class times : bool { whole_step, start };

/// The lanes that no axis separates from `other`. Coordinate axes separate most, so the others are
/// tested only if lanes remain.
template <times At, class Extents>
lanes touching(const extents_pack& packed, const Extents& other) {
    constexpr std::size_t parts = size / float_width;
    mask_of<float> apart[parts] = {};
    const auto separate = [&](std::size_t a) {
        float_pack all[4];
        for (std::size_t c = 0; c < 4; ++c) all[c] = float_pack(other(4 * a + c));
        for (std::size_t part = 0; part < parts; ++part) {
            const auto column = [&](std::size_t c) {
                return float_pack::load_aligned(&packed.at[4 * a + c][float_width * part]);
            };
            if constexpr (At == times::start)
                apart[part] = apart[part] | (column(0) > all[2]) | (column(2) < all[0]);
            else
                apart[part] = apart[part] | ((column(0) > all[2]) & (column(1) > all[3])) |
                              ((column(2) < all[0]) & (column(3) < all[1]));
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
    lanes found = 0;
    for (std::size_t lane = 0; lane < size; ++lane) found |= same[lane] & (lanes(1) << lane);
    return found;
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
template <std::size_t N, std::size_t M, times At, bool OneTree>
void pairs_of_leaves(const extents_levels& a, std::size_t p, const extents_levels& b, std::size_t q,
                     found_pairs& found) {
    const extents_pack &leaf = a.at[0].packs[p], &other = b.at[0].packs[q];
    const bool is_same = OneTree && p == q;
    const lanes of_other = touching<At>(other, hull_reader{a.at[0].hulls[p]});
    if (of_other == 0) return;
    const lanes of_leaf = touching<At>(leaf, hull_reader{b.at[0].hulls[q]});
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

template <std::size_t N, std::size_t M, times At, bool OneTree = N == M>
void find_pairs(const extents_levels& a, const extents_levels& b, std::size_t first,
                std::size_t end, void* context, search_kernels::visitor visit) {
    struct node {
        std::size_t level, position;
    };
    node open[size * extents_levels::most];
    found_pairs found(context, visit);
    for (std::size_t p = first; p < end; ++p) {
        const hull_reader from{a.at[0].hulls[p]};
        std::size_t opened = 0;
        open[opened++] = {b.count - 1, 0};
        while (opened > 0) {
            const node n = open[--opened];
            if (n.level == 0) {
                pairs_of_leaves<N, M, At, OneTree>(a, p, b, n.position, found);
                continue;
            }
            const std::size_t below = n.level - 1;
            const std::size_t least = OneTree ? p >> (4 * below) : 0;
            const lanes some = touching<At>(b.at[n.level].packs[n.position], from);
            for_each_lane(some, [&](std::uint32_t i) {
                const std::size_t child = size * n.position + i;
                if (child >= least) open[opened++] = {below, child};
            });
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
                                            find_pairs<2, 2, times::whole_step, false>,
                                            find_pairs<1, 3, times::start>,
                                            find_pairs<2, 2, times::start>,
                                            find_pairs<3, 3, times::start>};

}  // namespace ccd::detail::ERRBOUND_INSTRUCTION_SET
