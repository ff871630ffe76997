// The SIMD pipeline: see ccd/batch_kernels.hpp for what is special about this file.
//
// Queries flow through stages; what a stage cannot settle is compacted into the next one's input,
// so that every stage works on full packs. Buffers hold one column per number (structure of
// arrays) and some hundred queries: they stay in the first cache.
#include "ccd/batch_kernels.hpp"

#include <ccd/static_filter.hpp>
#include <cstdint>
#include <xsimd/xsimd.hpp>

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

inline std::size_t count_of(std::uint32_t bits) {
    return static_cast<std::size_t>(__builtin_popcount(bits));
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
    pipeline(outcome* answers, cull_state& axes, stage_report* report)
        : answers_(answers), axes_(axes), report_(report) {}

    /// `read(i, at)` writes the 24 coordinates of query i to at[0], at[block], at[2·block], ...: by
    /// point, end of the step, axis.
    template <class Read>
    void run(std::size_t count, const Read& read) {
        for (std::size_t first = 0; first < count; first += block) {
            const std::size_t size = count - first < block ? count - first : block;
            for (std::size_t i = 0; i < size; ++i) {
                read(first + i, &coordinates_[0][i]);
                answers_[first + i] = outcome::separate;
            }
            test_axes(static_cast<std::uint32_t>(first), size);
            if (to_coplanarity_.size >= block) test_coplanarity();
            if (to_inside_.size >= block) test_inside();
            if (parts_[0].size >= block) subdivide();
        }
        test_coplanarity();
        test_inside();
        subdivide();
    }

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

    /// Packs of the queue from its start, emptying it: `test(at, count)`.
    template <class Queue, class Test>
    static void for_each_pack(Queue& from, const Test& test) {
        from.pad();
        for (std::size_t at = 0; at < from.size; at += width)
            test(at, from.size - at < width ? from.size - at : width);
        from.size = 0;
    }

    void test_axes(std::uint32_t first, std::size_t size) {
        stage_turn turn(report_, stage::axes);
        for (std::size_t i = size; i % width != 0; ++i)
            for (auto& column : coordinates_) column[i] = 0;
        std::size_t separate = 0;
        const bool asked = axes_.blocks_to_pass == 0;
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
            std::uint32_t query[width];
            for (std::size_t i = 0; i < width; ++i)
                query[i] = first + static_cast<std::uint32_t>(at + i);
            to_coplanarity_.append(values, query, left);
        }
        if (asked) {
            turn.count(size, separate, 0);
            judge_axes(separate, size);
        } else {
            turn.leave_out(size);
            --axes_.blocks_to_pass;
        }
    }

    /// The cull costs about as much as the next stage. Where it settles fewer than a quarter of
    /// several blocks, it is left out of the next ones.
    void judge_axes(std::size_t settled, std::size_t of) {
        constexpr std::size_t patience = 4, pause = 124;
        axes_.poor_blocks = 4 * settled < of ? axes_.poor_blocks + 1 : 0;
        if (axes_.poor_blocks < patience) return;
        axes_ = {0, pause};
    }

    void test_coplanarity() {
        stage_turn turn(report_, stage::coplanarity);
        for_each_pack(to_coplanarity_, [&](std::size_t at, std::size_t count) {
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
        for_each_pack(to_inside_, [&](std::size_t at, std::size_t count) {
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
        for (int depth = 0; parts_[depth % 2].size > 0; ++depth) {
            auto &whole = parts_[depth % 2], &halved = parts_[(depth + 1) % 2];
            for_each_pack(whole, [&](std::size_t at, std::size_t count) {
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
    cull_state& axes_;
    stage_report* report_;
    alignas(64) double coordinates_[24][block];
    // A stage runs when a block waits for it, and may then receive all that its predecessor has.
    queue<difference_columns, 2 * block> to_coplanarity_;
    queue<difference_columns, 3 * block> to_inside_;
    std::array<queue<part_columns, 6 * block>, 2> parts_;  ///< the first receives whole steps
};

inline void read_row(const double* row, double* to) {
    for (std::size_t k = 0; k < 3; ++k) to[k * block] = row[k];
}

template <template <class> class Query, template <class> class Forms, class Indices>
void decide_indexed(const vertex_rows& positions, const Indices* queries, std::size_t count,
                    outcome* answers, cull_state& axes, stage_report* report) {
    pipeline<Query, Forms> stages(answers, axes, report);
    stages.run(count, [&](std::size_t i, double* at) {
        for (const index v : vertices_of(queries[i])) {
            read_row(positions.before + 3 * std::size_t(v), at);
            read_row(positions.after + 3 * std::size_t(v), at + 3 * block);
            at += 6 * block;
        }
    });
}

template <template <class> class Query, template <class> class Forms>
void decide_stored(const Query<double>* queries, std::size_t count, outcome* answers,
                   cull_state& axes, stage_report* report) {
    static_assert(sizeof(Query<double>) == 24 * sizeof(double));
    pipeline<Query, Forms> stages(answers, axes, report);
    const double* numbers = reinterpret_cast<const double*>(queries);
    stages.run(count, [&](std::size_t i, double* at) {
        for (std::size_t c = 0; c < 24; ++c) at[c * block] = numbers[24 * i + c];
    });
}

}  // namespace

const batch_kernels kernels = {
    decide_indexed<vertex_face, vertex_face_forms, vertex_face_indices>,
    decide_indexed<edge_edge, edge_edge_forms, edge_edge_indices>,
    decide_stored<vertex_face, vertex_face_forms>,
    decide_stored<edge_edge, edge_edge_forms>,
};

}  // namespace ccd::ERRBOUND_INSTRUCTION_SET
