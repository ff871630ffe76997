// The SIMD pipeline: see ccd/batch_kernels.hpp for what is special about this file.
//
// Queries flow through stages; what a stage cannot settle is compacted into the next one's input,
// so that every stage works on full packs. Buffers hold one column per number (structure of
// arrays) and some hundred queries: they stay in the first cache.
#include "ccd/batch_kernels.hpp"

#include <ccd/static_filter.hpp>
#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "ccd/rounded_positions.hpp"
#include "ccd/stage_turn.hpp"

namespace ccd::ERRBOUND_INSTRUCTION_SET {
namespace {

using pack = xsimd::batch<double, xsimd::default_arch>;
using pack_mask = xsimd::batch_bool<double, xsimd::default_arch>;
constexpr std::size_t width = pack::size;

/// Queries are read in blocks of this many.
constexpr std::size_t block = 64;
static_assert(block % width == 0);

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

    /// Appends those lanes of `values` that are set in `bits`.
    void append(const double (&values)[Columns][width], const std::uint32_t* of,
                std::uint32_t bits) {
        for (std::size_t i = 0; bits != 0; ++i, bits >>= 1) {
            if ((bits & 1) == 0) continue;
            for (std::size_t c = 0; c < Columns; ++c) column[c][size] = values[c][i];
            query[size++] = of[i];
        }
    }
    /// Makes the last pack a whole one: its other lanes hold zeros and are never looked at.
    void pad() {
        for (std::size_t i = size; i % width != 0; ++i)
            for (std::size_t c = 0; c < Columns; ++c) column[c][i] = 0;
    }
};

/// The lanes that are set in a mask, as bits; of the first `count` lanes.
inline std::uint32_t lanes_of(const pack_mask& m, std::size_t count) {
    bool set[width];
    m.store_unaligned(set);
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < width && i < count; ++i) bits |= std::uint32_t(set[i]) << i;
    return bits;
}

constexpr index vertex_of(const vertex_face_indices& q, std::size_t point) {
    return point == 0 ? q.v : point == 1 ? q.f0 : point == 2 ? q.f1 : q.f2;
}
constexpr index vertex_of(const edge_edge_indices& q, std::size_t point) {
    return point == 0 ? q.a0 : point == 1 ? q.a1 : point == 2 ? q.b0 : q.b1;
}

inline std::size_t count_of(std::uint32_t bits) {
    return static_cast<std::size_t>(__builtin_popcount(bits));
}

/// Whether a cull is to be asked now; it counts down its pause.
inline bool is_due(cull_state& state) {
    if (state.blocks_to_pass == 0) return true;
    --state.blocks_to_pass;
    return false;
}

/// A cull costs about as much as the next stage. Where it settles fewer than a quarter of several
/// blocks in a row, it is left out of the next ones.
inline void judge(cull_state& state, std::size_t settled, std::size_t of) {
    constexpr std::size_t patience = 4, pause = 124;
    state.poor_blocks = 4 * settled < of ? state.poor_blocks + 1 : 0;
    if (state.poor_blocks >= patience) state = {0, pause};
}

/// The coordinates of the three differences b, c, p at both ends, in a fixed order.
constexpr std::size_t difference_columns = 18;
using difference_values = double[difference_columns][width];

inline void store_differences(const coplanarity_forms<pack>& f, difference_values& to) {
    std::size_t c = 0;
    for (const auto* v : {&f.b, &f.c, &f.p})
        for (const auto* axis : {&v->x, &v->y, &v->z})
            for (const int end : {0, 1}) (*axis)[end].store_unaligned(to[c++]);
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
    using part_values = double[part_columns][width];

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

    void test_axes(const std::uint32_t* ids, std::size_t size, cull_state* axes) {
        stage_turn turn(axes != nullptr ? report_ : nullptr, stage::axes);
        for (std::size_t i = size; i % width != 0; ++i)
            for (auto& column : coordinates_) column[i] = 0;
        const bool asked = axes != nullptr && is_due(*axes);
        std::size_t separate = 0;
        for (std::size_t at = 0; at < size; at += width) {
            const Forms<pack> forms = forms_of_coordinates(at);
            const std::size_t count = size - at < width ? size - at : width;
            std::uint32_t left = (std::uint32_t(1) << count) - 1;
            if (asked) {
                const static_filter::sizes<pack> sizes(forms);
                const std::uint32_t gone =
                    lanes_of(static_filter::parted<pack>(forms, sizes) & sizes.usable, count);
                separate += count_of(gone);
                left &= ~gone;
            }
            if (left == 0) continue;
            difference_values values;
            store_differences(forms, values);
            to_coplanarity_.append(values, ids + at, left);
        }
        if (asked) {
            turn.count(size, separate, 0);
            judge(*axes, separate, size);
        } else {
            turn.leave_out(size);
        }
    }

    void test_coplanarity() {
        stage_turn turn(report_, stage::coplanarity);
        for_each_pack(to_coplanarity_, block, [&](std::size_t at, std::size_t count) {
            const Forms<pack> forms = forms_at(to_coplanarity_, at);
            const static_filter::sizes<pack> sizes(forms);
            const auto y = errbound::control_values_of(forms.y());
            const pack error = sizes.template error_of_y<Forms>();
            const std::uint32_t left = lanes_of(
                !(sizes.usable & (static_filter::above(y, error) | static_filter::below(y, error))),
                count);
            turn.count(count, count - count_of(left), 0);
            if (left == 0) return;
            difference_values values;
            store_differences(forms, values);
            to_inside_.append(values, &to_coplanarity_.query[at], left);
        });
    }

    void test_inside() {
        stage_turn turn(report_, stage::inside);
        for_each_pack(to_inside_, block, [&](std::size_t at, std::size_t count) {
            const Forms<pack> forms = forms_at(to_inside_, at);
            const static_filter::sizes<pack> sizes(forms);
            const std::uint32_t* query = &to_inside_.query[at];
            const std::uint32_t unusable = lanes_of(!sizes.usable, count);
            for (std::size_t i = 0; i < count; ++i)
                if ((unusable >> i & 1) != 0) answers_[query[i]] = outcome::uncertain;
            const static_filter::whole_step<pack, Forms> whole(forms, sizes);
            const std::uint32_t left = lanes_of(!whole.outside(), count) & ~unusable;
            turn.count(count, count - count_of(left | unusable), 0);
            if (left == 0) return;
            part_values values;
            store_form(whole.forms.y, values, 0);
            for (std::size_t i = 0; i < constraints; ++i)
                store_form(whole.forms.g[i], values, 4 + 5 * i);
            whole.errors.y.store_unaligned(values[error_columns]);
            whole.errors.g.store_unaligned(values[error_columns + 1]);
            parts_[0].append(values, query, left);
        });
    }

    template <int N, class Queue>
    static errbound::control_values<pack, N> load_form(const Queue& from, std::size_t column,
                                                       std::size_t at) {
        errbound::control_values<pack, N> c;
        for (int i = 0; i <= N; ++i) c[i] = from.load(column + static_cast<std::size_t>(i), at);
        return c;
    }
    template <int N>
    static void store_form(const errbound::control_values<pack, N>& c, part_values& to,
                           std::size_t column) {
        for (int i = 0; i <= N; ++i) c[i].store_unaligned(to[column + static_cast<std::size_t>(i)]);
    }
    template <int N, class Queue>
    static void halve_form(const Queue& from, std::size_t column, std::size_t at, part_values& left,
                           part_values& right) {
        const auto halves = errbound::halves(load_form<N>(from, column, at));
        store_form(halves.first, left, column);
        store_form(halves.second, right, column);
    }

    void settle(const std::uint32_t* query, std::uint32_t lanes, outcome answer,
                std::size_t& settled) {
        for (std::size_t i = 0; lanes != 0; ++i, lanes >>= 1) {
            if ((lanes & 1) == 0 || answers_[query[i]] != outcome::separate) continue;
            answers_[query[i]] = answer;
            ++settled;
        }
    }

    /// All parts are halved alike, level by level.
    void subdivide() {
        stage_turn turn(report_, stage::subdivision);
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
                std::uint32_t open = lanes_of(!excluded, count);
                for (std::size_t i = 0; i < count; ++i)
                    if (answers_[query[i]] != outcome::separate) open &= ~(std::uint32_t(1) << i);
                if (open == 0) return;
                const std::uint32_t hit = open & lanes_of(collides, count);
                settle(query, hit, outcome::collides, collide);
                open &= ~hit;
                if (open == 0) return;
                std::uint32_t hopeless = 0;
                if (depth == static_filter::max_depth || halved.size + 2 * width > halved.capacity)
                    hopeless = open;
                else if (depth >= static_filter::patient_depth)
                    hopeless = open & lanes_of(static_filter::within_error(y, error_of_y), count);
                settle(query, hopeless, outcome::uncertain, uncertain);
                open &= ~hopeless;
                if (open == 0) return;
                part_values left, right;
                halve_form<3>(whole, 0, at, left, right);
                for (std::size_t i = 0; i < constraints; ++i)
                    halve_form<4>(whole, 4 + 5 * i, at, left, right);
                for (part_values* half : {&left, &right}) {
                    error_of_y.store_unaligned((*half)[error_columns]);
                    error_of_g.store_unaligned((*half)[error_columns + 1]);
                    halved.append(*half, query, open);
                }
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

/// By how much an axis parts the features at one end of the step, if it does.
struct gap {
    float_pack above, below;
};
template <class Indices>
gap gap_between(const float_pack (&x)[4]) {
    if constexpr (std::is_same_v<Indices, vertex_face_indices>)
        return {x[0] - max(max(x[1], x[2]), x[3]), min(min(x[1], x[2]), x[3]) - x[0]};
    else
        return {min(x[2], x[3]) - max(x[0], x[1]), min(x[0], x[1]) - max(x[2], x[3])};
}
template <class Indices>
float_pack parted_by(const float_pack (&start)[4], const float_pack (&end)[4]) {
    const gap g0 = gap_between<Indices>(start), g1 = gap_between<Indices>(end);
    return max(min(g0.above, g1.above), min(g0.below, g1.below));
}

/// Whether an axis (x, y, z, x ± y, y ± z, z ± x) certainly parts the features of the queries from
/// `lane` on throughout the step: static_filter::parted in single precision.
template <class Indices>
xsimd::batch_bool<float, xsimd::default_arch> parted(const rounded_columns& columns,
                                                     std::size_t lane) {
    float_pack coordinate[3][2][4], along = float_pack(-1.0f), across = float_pack(-1.0f);
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t p = 0; p < 4; ++p)
            for (std::size_t end = 0; end < 2; ++end)
                coordinate[k][end][p] = columns.load(6 * p + 3 * end + k, lane);
        along = max(along, parted_by<Indices>(coordinate[k][0], coordinate[k][1]));
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const auto &u = coordinate[k], &v = coordinate[(k + 1) % 3];
        float_pack sum[2][4], difference[2][4];
        for (std::size_t end = 0; end < 2; ++end)
            for (std::size_t p = 0; p < 4; ++p) {
                sum[end][p] = u[end][p] + v[end][p];
                difference[end][p] = u[end][p] - v[end][p];
            }
        across = max(across, parted_by<Indices>(sum[0], sum[1]));
        across = max(across, parted_by<Indices>(difference[0], difference[1]));
    }
    return (along > float_pack(0.0f)) | (across > float_pack(rounded_positions::margin));
}

/// Writes those of the queries first, first + 1, ... that no axis certainly parts to `left`;
/// returns their number.
template <class Indices>
std::size_t cull(const float* rounded, const Indices* queries, std::uint32_t first,
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
        bool separate[float_width];
        parted<Indices>(columns, at).store_unaligned(separate);
        for (std::size_t i = 0; i < float_width && at + i < count; ++i) {
            left[size] = first + static_cast<std::uint32_t>(at + i);
            size += !separate[i];
        }
    }
    return size;
}

inline void read_row(const double* row, double* to, std::size_t stride) {
    for (std::size_t k = 0; k < 3; ++k) to[k * stride] = row[k];
}

template <template <class> class Query, template <class> class Forms, class Indices>
void decide_indexed(const batch_positions& positions, const Indices* queries, std::size_t count,
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
            stage_turn turn(report, stage::axes);
            const std::size_t left =
                cull(positions.rounded, queries, static_cast<std::uint32_t>(first), size, ids);
            turn.count(size, size - left, 0);
            turn.end();
            judge(axes.in_float, size - left, size);
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
    decide_indexed<vertex_face, linear_vertex_face_forms, vertex_face_indices>,
    decide_indexed<edge_edge, linear_edge_edge_forms, edge_edge_indices>,
    decide_stored<vertex_face, linear_vertex_face_forms>,
    decide_stored<edge_edge, linear_edge_edge_forms>,
};

}  // namespace ccd::ERRBOUND_INSTRUCTION_SET
