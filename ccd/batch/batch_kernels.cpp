// The SIMD pipeline: see ccd/batch/batch_kernels.hpp for what is special about this file.
//
// Queries flow through stages; what a stage cannot settle is compacted into the next one's input,
// so that every stage works on full packs. Buffers hold one column per number (structure of
// arrays) and some hundred queries: about 200 KB in all, which stay in the second cache.
#include "ccd/batch/batch_kernels.hpp"

#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "ccd/batch/rounded_positions.hpp"
#include "ccd/exact/stage_timer.hpp"
#include "ccd/exact/static_filter.hpp"

namespace ccd::ERRBOUND_INSTRUCTION_SET {
namespace {

using pack = xsimd::batch<double, xsimd::default_arch>;
using pack_mask = xsimd::batch_bool<double, xsimd::default_arch>;
constexpr std::size_t width = pack::size;

/// Queries are read in blocks of this many.
constexpr std::size_t block = 64;
static_assert(block % width == 0);

// Two operations that xsimd 8 lacks, with what the instruction sets have for them.

/// The lanes that are set, as bits.
template <class T>
std::uint32_t bits_of(const xsimd::batch_bool<T, xsimd::default_arch>& m) {
#if defined __AVX512F__
    return m.data;
#elif defined __AVX__
    if constexpr (sizeof(T) == sizeof(double))
        return static_cast<std::uint32_t>(_mm256_movemask_pd(m));
    else
        return static_cast<std::uint32_t>(_mm256_movemask_ps(m));
#elif defined __SSE2__
    if constexpr (sizeof(T) == sizeof(double))
        return static_cast<std::uint32_t>(_mm_movemask_pd(m));
    else
        return static_cast<std::uint32_t>(_mm_movemask_ps(m));
#else
    bool set[xsimd::batch_bool<T, xsimd::default_arch>::size];
    m.store_unaligned(set);
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < std::size(set); ++i) bits |= std::uint32_t(set[i]) << i;
    return bits;
#endif
}

#if defined __AVX2__ && !defined __AVX512F__
/// For every set of four lanes, the halves of those lanes in order.
struct lane_orders {
    alignas(32) std::int32_t halves[16][8];

    constexpr lane_orders() : halves() {
        for (int bits = 0; bits < 16; ++bits) {
            int k = 0;
            for (int lane = 0; lane < 4; ++lane) {
                if ((bits >> lane & 1) == 0) continue;
                halves[bits][k++] = 2 * lane;
                halves[bits][k++] = 2 * lane + 1;
            }
        }
    }
};
constexpr lane_orders orders;
#endif

/// Writes the lanes that are set in `bits` one after the other; may write up to a pack's width.
inline void compress(const pack& values, std::uint32_t bits, double* to) {
#if defined __AVX512F__
    _mm512_storeu_pd(to, _mm512_maskz_compress_pd(static_cast<__mmask8>(bits), values));
#elif defined __AVX2__
    const __m256i order = _mm256_load_si256(reinterpret_cast<const __m256i*>(orders.halves[bits]));
    const __m256 packed = _mm256_permutevar8x32_ps(_mm256_castpd_ps(values), order);
    _mm256_storeu_pd(to, _mm256_castps_pd(packed));
#else
    double lanes[width];
    values.store_unaligned(lanes);
    std::size_t k = 0;
    for (std::size_t i = 0; i < width; ++i) {
        to[k] = lanes[i];
        k += bits >> i & 1;
    }
#endif
}

inline std::size_t count_of(std::uint32_t bits) {
    return static_cast<std::size_t>(__builtin_popcount(bits));
}

/// The first `count` lanes.
inline std::uint32_t first_lanes(std::size_t count) {
    return (std::uint32_t(1) << count) - 1;
}

/// A queue of queries: `Columns` numbers each, and the query they belong to.
template <std::size_t Columns, std::size_t Capacity>
struct queue {
    static constexpr std::size_t capacity = Capacity;
    /// An odd number of cache lines apart, so that columns do not compete for the same ones.
    static constexpr std::size_t stride = Capacity / 8 * 8 + (Capacity / 8 % 2 == 0 ? 8 : 16);
    alignas(64) double column[Columns][stride];
    std::uint32_t query[Capacity];
    std::size_t size = 0;

    pack load(std::size_t c, std::size_t at) const { return pack::load_unaligned(&column[c][at]); }

    /// Puts the lanes of one column that are set in `bits` behind the first size + offset.
    void put(std::size_t c, const pack& values, std::uint32_t bits, std::size_t offset = 0) {
        compress(values, bits, &column[c][size + offset]);
    }
    /// Takes in what was put, for the queries `of` that are set in `bits`.
    void commit(const std::uint32_t* of, std::uint32_t bits) {
        for (; bits != 0; bits &= bits - 1) query[size++] = of[__builtin_ctz(bits)];
    }
    /// Makes the last pack a whole one: its other lanes hold zeros and are never looked at.
    void pad() {
        for (std::size_t i = size; i % width != 0; ++i)
            for (std::size_t c = 0; c < Columns; ++c) column[c][i] = 0;
    }
};

constexpr index vertex_of(const vertex_face_pair& q, std::size_t point) {
    return point == 0 ? q.v : point == 1 ? q.f0 : point == 2 ? q.f1 : q.f2;
}
constexpr index vertex_of(const edge_edge_pair& q, std::size_t point) {
    return point == 0 ? q.a0 : point == 1 ? q.a1 : point == 2 ? q.b0 : q.b1;
}

/// Whether a cull is to be asked now; it counts down its pause.
inline bool is_due(cull_state& state) {
    if (state.blocks_to_pass == 0) return true;
    --state.blocks_to_pass;
    return false;
}

/// A cull costs about as much as the next stage. Where it settles fewer than a quarter of several
/// blocks in a row, it is left out of the next ones.
inline void update_pause(cull_state& state, std::size_t settled, std::size_t of) {
    constexpr std::size_t patience = 4, pause = 124;
    state.poor_blocks = 4 * settled < of ? state.poor_blocks + 1 : 0;
    if (state.poor_blocks >= patience) state = {0, pause};
}

/// The coordinates of the three differences b, c, p at both ends, in a fixed order.
constexpr std::size_t difference_columns = 18;

/// Appends the differences of the queries `of` that are set in `bits`.
template <class Queue>
void append(Queue& to, const coplanarity_forms<pack>& f, const std::uint32_t* of,
            std::uint32_t bits) {
    std::size_t c = 0;
    for (const auto* v : {&f.b, &f.c, &f.p})
        for (const auto* axis : {&v->x, &v->y, &v->z})
            for (const int end : {0, 1}) to.put(c++, (*axis)[end], bits);
    to.commit(of, bits);
}

template <template <class> class Query, template <class> class Forms>
class pipeline {
  public:
    pipeline(outcome* answers, stage_report* report) : answers_(answers), report_(report) {}

    /// Takes in queries `ids[0]`, ..., whose answers are `separate` so far. `read(id, at)` writes
    /// the 24 coordinates of a query to at[0], at[stride], at[2·stride], ...: by point, end of the
    /// step, axis. Where `axes` is null the cull by axes is left out.
    template <class Read>
    void take(const std::uint32_t* ids, std::size_t count, const Read& read, cull_state* axes) {
        for (std::size_t first = 0; first < count; first += block) {
            const std::size_t size = count - first < block ? count - first : block;
            for (std::size_t i = 0; i < size; ++i) read(ids[first + i], &coordinates_[0][i]);
            test_axes(ids + first, size, axes);
            settle_waiting(block);
        }
    }

    /// Settles what still waits.
    void finish() { settle_waiting(1); }

    static constexpr std::size_t stride = block + 8;  ///< of coordinates

  private:
    static constexpr std::size_t constraints =
        std::tuple_size_v<decltype(std::declval<Forms<pack>>().inside())>;
    /// A part's control values, of Y and of each G_i, and their two error bounds.
    static constexpr std::size_t error_columns = 4 + 5 * constraints;
    static constexpr std::size_t part_columns = error_columns + 2;

    template <class Queue>
    static Forms<pack> forms_at(const Queue& from, std::size_t at) {
        const auto motion = [&](std::size_t c) {
            return vector_form<pack, 1>{{{from.load(c, at), from.load(c + 1, at)}},
                                        {{from.load(c + 2, at), from.load(c + 3, at)}},
                                        {{from.load(c + 4, at), from.load(c + 5, at)}}};
        };
        return Forms<pack>(motion(0), motion(6), motion(12));
    }

    Forms<pack> forms_of_coordinates(std::size_t at) const {
        const auto point_at = [&](std::size_t c) {
            return point<pack>{pack::load_aligned(&coordinates_[c][at]),
                               pack::load_aligned(&coordinates_[c + 1][at]),
                               pack::load_aligned(&coordinates_[c + 2][at])};
        };
        const auto moving = [&](std::size_t c) {
            return moving_point<pack>{point_at(c), point_at(c + 3)};
        };
        return Forms<pack>(Query<pack>{moving(0), moving(6), moving(12), moving(18)});
    }

    /// Runs each stage as long as at least `enough` queries wait for it.
    void settle_waiting(std::size_t enough) {
        while (to_coplanarity_.size >= enough) {
            test_coplanarity();
            while (to_inside_.size >= enough) {
                test_inside();
                if (parts_[0].size >= enough) subdivide();
            }
        }
        while (to_inside_.size >= enough) test_inside();
        if (parts_[0].size >= enough) subdivide();
    }

    /// Takes up to `most` queries from the end of the queue, in packs: `test(at, count)`.
    template <class Queue, class Test>
    static void for_each_pack(Queue& from, std::size_t most, const Test& test) {
        from.pad();
        const std::size_t end = from.size;
        from.size = end < most ? 0 : end - most;
        for (std::size_t at = from.size; at < end; at += width)
            test(at, end - at < width ? end - at : width);
    }

    [[gnu::flatten]] void test_axes(const std::uint32_t* ids, std::size_t size, cull_state* axes) {
        stage_timer turn(axes != nullptr ? report_ : nullptr, stage::axes);
        for (std::size_t i = size; i % width != 0; ++i)
            for (auto& column : coordinates_) column[i] = 0;
        const bool asked = axes != nullptr && is_due(*axes);
        std::size_t separate = 0;
        for (std::size_t at = 0; at < size; at += width) {
            const Forms<pack> forms = forms_of_coordinates(at);
            const std::size_t count = size - at < width ? size - at : width;
            std::uint32_t left = first_lanes(count);
            if (asked) {
                const static_filter::sizes<pack> sizes(forms);
                left &= ~bits_of(static_filter::separated<pack>(forms, sizes) & sizes.usable);
                separate += count - count_of(left);
            }
            if (left != 0) append(to_coplanarity_, forms, ids + at, left);
        }
        if (asked) {
            turn.count(size, separate, 0);
            update_pause(*axes, separate, size);
        } else {
            turn.leave_out(size);
        }
    }

    [[gnu::flatten]] void test_coplanarity() {
        stage_timer turn(report_, stage::coplanarity);
        for_each_pack(to_coplanarity_, block, [&](std::size_t at, std::size_t count) {
            const Forms<pack> forms = forms_at(to_coplanarity_, at);
            const static_filter::sizes<pack> sizes(forms);
            const auto y = errbound::roots::control_values_of(forms.y());
            const pack error = sizes.template error_of_y<Forms>();
            const pack_mask rootless =
                static_filter::above(y, error) | static_filter::below(y, error);
            const std::uint32_t left = first_lanes(count) & ~bits_of(sizes.usable & rootless);
            turn.count(count, count - count_of(left), 0);
            if (left != 0) append(to_inside_, forms, &to_coplanarity_.query[at], left);
        });
    }

    [[gnu::flatten]] void test_inside() {
        stage_timer turn(report_, stage::inside);
        for_each_pack(to_inside_, block, [&](std::size_t at, std::size_t count) {
            const Forms<pack> forms = forms_at(to_inside_, at);
            const static_filter::sizes<pack> sizes(forms);
            const std::uint32_t* query = &to_inside_.query[at];
            const std::uint32_t usable = first_lanes(count) & bits_of(sizes.usable);
            for (std::size_t i = 0; i < count; ++i)
                if ((usable >> i & 1) == 0) answers_[query[i]] = outcome::uncertain;
            const static_filter::whole_step<pack, Forms> whole(forms, sizes);
            const std::uint32_t left = usable & ~bits_of(whole.outside());
            turn.count(count, count_of(usable) - count_of(left), 0);
            if (left == 0) return;
            put_form(parts_[0], whole.forms.y, 0, left);
            for (std::size_t i = 0; i < constraints; ++i)
                put_form(parts_[0], whole.forms.g[i], 4 + 5 * i, left);
            parts_[0].put(error_columns, whole.errors.y, left);
            parts_[0].put(error_columns + 1, whole.errors.g, left);
            parts_[0].commit(query, left);
        });
    }

    template <int N, class Queue>
    static errbound::roots::control_values<pack, N> load_form(const Queue& from, std::size_t column,
                                                              std::size_t at) {
        errbound::roots::control_values<pack, N> c;
        for (int i = 0; i <= N; ++i) c[i] = from.load(column + static_cast<std::size_t>(i), at);
        return c;
    }
    template <int N, class Queue>
    static void put_form(Queue& to, const errbound::roots::control_values<pack, N>& c,
                         std::size_t column, std::uint32_t lanes, std::size_t offset = 0) {
        for (int i = 0; i <= N; ++i)
            to.put(column + static_cast<std::size_t>(i), c[i], lanes, offset);
    }

    void settle(const std::uint32_t* query, std::uint32_t lanes, outcome answer,
                std::size_t& settled) {
        for (; lanes != 0; lanes &= lanes - 1) {
            outcome& known = answers_[query[__builtin_ctz(lanes)]];
            if (known != outcome::separate) continue;
            known = answer;
            ++settled;
        }
    }

    /// All parts are halved alike, level by level.
    [[gnu::flatten]] void subdivide() {
        stage_timer turn(report_, stage::subdivision);
        std::size_t collide = 0, uncertain = 0;
        const std::size_t entered = parts_[0].size;
        for (std::size_t depth = 0; parts_[depth % 2].size > 0; ++depth) {
            auto &whole = parts_[depth % 2], &halved = parts_[(depth + 1) % 2];
            for_each_pack(whole, whole.capacity, [&](std::size_t at, std::size_t count) {
                const pack error_of_y = whole.load(error_columns, at);
                const pack error_of_g = whole.load(error_columns + 1, at);
                const auto y = load_form<3>(whole, 0, at);
                pack_mask excluded =
                    static_filter::above(y, error_of_y) | static_filter::below(y, error_of_y);
                pack_mask collides = static_filter::changes_sign(y, error_of_y);
                for (std::size_t i = 0; i < constraints; ++i) {
                    const auto g = load_form<4>(whole, 4 + 5 * i, at);
                    excluded = excluded | static_filter::below(g, error_of_g);
                    collides = collides & static_filter::above(g, error_of_g);
                }
                const std::uint32_t* query = &whole.query[at];
                std::uint32_t open = first_lanes(count) & ~bits_of(excluded);
                for (std::size_t i = 0; i < count; ++i)
                    if (answers_[query[i]] != outcome::separate) open &= ~(std::uint32_t(1) << i);
                if (open == 0) return;
                const std::uint32_t hit = open & bits_of(collides);
                settle(query, hit, outcome::collides, collide);
                open &= ~hit;
                if (open == 0) return;
                std::uint32_t hopeless = 0;
                if (depth == static_filter::max_depth || halved.size + 2 * width > halved.capacity)
                    hopeless = open;
                else if (depth >= static_filter::patient_depth)
                    hopeless = open & bits_of(static_filter::within_error(y, error_of_y));
                settle(query, hopeless, outcome::uncertain, uncertain);
                open &= ~hopeless;
                if (open == 0) return;
                const std::size_t lefts = count_of(open);  // the right halves come behind them
                const auto put_halves = [&](const auto& form, std::size_t column) {
                    const auto halves = errbound::roots::halves(form);
                    put_form(halved, halves.first, column, open);
                    put_form(halved, halves.second, column, open, lefts);
                };
                put_halves(y, 0);
                for (std::size_t i = 0; i < constraints; ++i)
                    put_halves(load_form<4>(whole, 4 + 5 * i, at), 4 + 5 * i);
                for (const std::size_t offset : {std::size_t(0), lefts}) {
                    halved.put(error_columns, error_of_y, open, offset);
                    halved.put(error_columns + 1, error_of_g, open, offset);
                }
                halved.commit(query, open);
                halved.commit(query, open);
            });
        }
        turn.count(entered, entered - collide - uncertain, collide);
    }

    outcome* answers_;
    stage_report* report_;
    alignas(64) double coordinates_[24][stride];
    // A stage runs when a block waits for it, and its predecessor hands it at most a block.
    queue<difference_columns, 2 * block> to_coplanarity_, to_inside_;
    std::array<queue<part_columns, 6 * block>, 2> parts_;  ///< the first receives whole steps
};

/// Queries of one turn of the cull in single precision.
constexpr std::size_t rounded_block = 256;

using float_pack = xsimd::batch<float, xsimd::default_arch>;
constexpr std::size_t float_width = float_pack::size;
static_assert(rounded_block % float_width == 0 && float_width % 4 == 0);

/// Columns of rounded coordinates: by point, end of the step, axis.
struct rounded_columns {
    alignas(64) float at[24][rounded_block + 16];

    /// Fills four lanes of the columns of point p from the rows of four vertices.
    void fill(std::size_t p, std::size_t lane, const float* const (&rows)[4]) {
        typedef float quad __attribute__((vector_size(16)));
        for (std::size_t end = 0; end < 2; ++end) {
            quad r[4];
            for (std::size_t i = 0; i < 4; ++i)
                __builtin_memcpy(&r[i], rows[i] + 4 * end, sizeof(quad));
            const quad xy0 = __builtin_shufflevector(r[0], r[2], 0, 4, 1, 5);
            const quad xy1 = __builtin_shufflevector(r[1], r[3], 0, 4, 1, 5);
            const quad z0 = __builtin_shufflevector(r[0], r[2], 2, 6, 3, 7);
            const quad z1 = __builtin_shufflevector(r[1], r[3], 2, 6, 3, 7);
            const quad columns[3] = {__builtin_shufflevector(xy0, xy1, 0, 4, 1, 5),
                                     __builtin_shufflevector(xy0, xy1, 2, 6, 3, 7),
                                     __builtin_shufflevector(z0, z1, 0, 4, 1, 5)};
            for (std::size_t k = 0; k < 3; ++k)
                __builtin_memcpy(&at[6 * p + 3 * end + k][lane], &columns[k], sizeof(quad));
        }
    }
    float_pack load(std::size_t column, std::size_t lane) const {
        return float_pack::load_aligned(&at[column][lane]);
    }
};

/// Whether an axis certainly parts the features of the queries from `lane` on.
template <class Pair>
xsimd::batch_bool<float, xsimd::default_arch> separated(const rounded_columns& columns,
                                                        std::size_t lane) {
    float_pack coordinates[3][2][4];
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t end = 0; end < 2; ++end)
            for (std::size_t p = 0; p < 4; ++p)
                coordinates[k][end][p] = columns.load(6 * p + 3 * end + k, lane);
    return rounded_axes::separated<Pair>(coordinates);
}

/// Writes those of the queries first, first + 1, ... that no axis certainly parts to `left`;
/// returns their number.
template <class Pair>
[[gnu::flatten]] std::size_t cull(const float* rounded, const Pair* queries, std::uint32_t first,
                                  std::size_t count, std::uint32_t* left) {
    rounded_columns columns;
    for (std::size_t at = 0; at < count; at += 4)
        for (std::size_t p = 0; p < 4; ++p) {
            const float* rows[4];
            for (std::size_t i = 0; i < 4; ++i) {
                // Lanes beyond the last query repeat it.
                const std::size_t q = first + (at + i < count ? at + i : count - 1);
                rows[i] = rounded + rounded_positions::row * std::size_t(vertex_of(queries[q], p));
            }
            columns.fill(p, at, rows);
        }
    std::size_t size = 0;
    for (std::size_t at = 0; at < count; at += float_width) {
        const std::size_t lanes = count - at < float_width ? count - at : float_width;
        std::uint32_t open = first_lanes(lanes) & ~bits_of(separated<Pair>(columns, at));
        for (; open != 0; open &= open - 1)
            left[size++] = first + static_cast<std::uint32_t>(at) +
                           static_cast<std::uint32_t>(__builtin_ctz(open));
    }
    return size;
}

inline void read_row(const double* row, double* to, std::size_t stride) {
    for (std::size_t k = 0; k < 3; ++k) to[k * stride] = row[k];
}

template <template <class> class Query, template <class> class Forms, class Pair>
void decide_indexed(const batch_positions& positions, const Pair* queries, std::size_t count,
                    outcome* answers, axes_state& axes, stage_report* report) {
    using stages_type = pipeline<Query, Forms>;
    stages_type stages(answers, report);
    const auto read = [&](std::uint32_t id, double* at) {
        for (std::size_t p = 0; p < 4; ++p) {
            const std::size_t row = 3 * std::size_t(vertex_of(queries[id], p));
            read_row(positions.exact.before + row, at, stages_type::stride);
            read_row(positions.exact.after + row, at + 3 * stages_type::stride,
                     stages_type::stride);
            at += 6 * stages_type::stride;
        }
    };
    for (std::size_t first = 0; first < count; first += rounded_block) {
        const std::size_t size = count - first < rounded_block ? count - first : rounded_block;
        for (std::size_t i = 0; i < size; ++i) answers[first + i] = outcome::separate;
        std::uint32_t ids[rounded_block];
        if (positions.rounded != nullptr && is_due(axes.in_float)) {
            stage_timer turn(report, stage::axes);
            const std::size_t left =
                cull(positions.rounded, queries, static_cast<std::uint32_t>(first), size, ids);
            turn.count(size, size - left, 0);
            turn.end();
            update_pause(axes.in_float, size - left, size);
            stages.take(ids, left, read, nullptr);
        } else {
            for (std::size_t i = 0; i < size; ++i) ids[i] = static_cast<std::uint32_t>(first + i);
            stages.take(ids, size, read, &axes.in_double);
        }
    }
    stages.finish();
}

template <template <class> class Query, template <class> class Forms>
void decide_stored(const Query<double>* queries, std::size_t count, outcome* answers,
                   axes_state& axes, stage_report* report) {
    static_assert(sizeof(Query<double>) == 24 * sizeof(double));
    using stages_type = pipeline<Query, Forms>;
    stages_type stages(answers, report);
    const double* numbers = reinterpret_cast<const double*>(queries);
    std::uint32_t ids[block];
    for (std::size_t first = 0; first < count; first += block) {
        const std::size_t size = count - first < block ? count - first : block;
        for (std::size_t i = 0; i < size; ++i) {
            ids[i] = static_cast<std::uint32_t>(first + i);
            answers[first + i] = outcome::separate;
        }
        stages.take(
            ids, size,
            [&](std::uint32_t id, double* at) {
                for (std::size_t c = 0; c < 24; ++c)
                    at[c * stages_type::stride] = numbers[24 * std::size_t(id) + c];
            },
            &axes.in_double);
    }
    stages.finish();
}

}  // namespace

const batch_kernels kernels = {
    decide_indexed<vertex_face, linear_vertex_face_forms, vertex_face_pair>,
    decide_indexed<edge_edge, linear_edge_edge_forms, edge_edge_pair>,
    decide_stored<vertex_face, linear_vertex_face_forms>,
    decide_stored<edge_edge, linear_edge_edge_forms>,
};

}  // namespace ccd::ERRBOUND_INSTRUCTION_SET
