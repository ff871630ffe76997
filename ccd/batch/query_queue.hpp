// Queues of queries between the stages of the batch kernels, as structures of arrays. Internal.
#pragma once

#include <ccd/kind.hpp>
#include <ccd/methods/forms.hpp>
#include <cstddef>
#include <cstdint>

#include "ccd/exact/simd.hpp"

namespace ccd::detail::ERRBOUND_INSTRUCTION_SET {
namespace {

/// A stage runs when at least this number of queries waits for it.
constexpr std::size_t block = 64;
static_assert(block % width == 0);

constexpr std::size_t lesser(std::size_t a, std::size_t b) {
    return a < b ? a : b;
}

template <std::size_t Columns, std::size_t Capacity>
struct query_queue {
    static constexpr std::size_t capacity = Capacity;
    /// An odd number of cache lines, so that columns do not compete for the same ones.
    static constexpr std::size_t stride = Capacity / 8 * 8 + (Capacity / 8 % 2 == 0 ? 8 : 16);
    alignas(64) double column[Columns][stride];
    std::uint32_t ids[Capacity];
    std::size_t size = 0;

    pack load(std::size_t c, std::size_t at) const { return pack::load_unaligned(&column[c][at]); }

    void put(std::size_t c, const pack& values, lanes some, std::size_t offset = 0) {
        compress(values, some, &column[c][size + offset]);
    }
    /// Completes the queries whose numbers `put` has written: the lanes `some` of `of` are their
    /// ids.
    void push_ids(const std::uint32_t* of, lanes some) {
        for_each_lane(some, [&](std::uint32_t lane) { ids[size++] = of[lane]; });
    }

    /// Removes up to `limit` queries from the end and calls visit(at, count) for packs of them. In
    /// the last pack, lanes from `count` on hold zeros and must not be used.
    template <class Visit>
    void pop_packs(std::size_t limit, const Visit& visit) {
        for (std::size_t i = size; i % width != 0; ++i)
            for (std::size_t c = 0; c < Columns; ++c) column[c][i] = 0;
        const std::size_t end = size;
        size -= lesser(size, limit);
        for (std::size_t at = size; at < end; at += width) visit(at, lesser(end - at, width));
    }
};

/// Queries stored as b, c, p at both ends of the step. A stage pushes at most a block, and runs
/// only if less than a block waits in the next queue.
template <kind K>
struct difference_queue : query_queue<18, 2 * block> {
    using forms = linear_forms<K, pack>;

    void push(const coplanarity_forms<pack>& f, const std::uint32_t* of, lanes some) {
        std::size_t c = 0;
        for (const auto* v : {&f.b, &f.c, &f.p})
            for (const auto* axis : {&v->x, &v->y, &v->z})
                for (const int end : {0, 1}) this->put(c++, (*axis)[end], some);
        this->push_ids(of, some);
    }
    forms forms_at(std::size_t at) const {
        const auto motion = [&](std::size_t c) {
            const auto axis = [&](std::size_t i) {
                return errbound::bernstein<pack, 1>{{this->load(i, at), this->load(i + 1, at)}};
            };
            return vector_form<pack, 1>{axis(c), axis(c + 2), axis(c + 4)};
        };
        return forms(motion(0), motion(6), motion(12));
    }
};

/// The stages' answers and counts. An answer is `uncertain` until a stage decides.
struct decisions {
    outcome* answers;
    stage_report* report;

    void write(const std::uint32_t* ids, lanes some, outcome answer) const {
        for_each_lane(some, [&](std::uint32_t lane) { answers[ids[lane]] = answer; });
    }
};

}  // namespace
}  // namespace ccd::detail::ERRBOUND_INSTRUCTION_SET
