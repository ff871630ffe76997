// Subdivision (ccd/exact/static_filter/subdivision.hpp) over packs. Parts are intervals of a
// query's step; those of all queries are halved level by level. Internal.
#pragma once

#include <array>
#include <ccd/explain.hpp>
#include <ccd/kind.hpp>
#include <ccd/methods/forms.hpp>
#include <cstddef>
#include <cstdint>

#include "ccd/batch/query_queue.hpp"
#include "ccd/exact/stage_timer.hpp"
#include "ccd/exact/static_filter/whole_step.hpp"

namespace ccd::detail::ERRBOUND_INSTRUCTION_SET {
namespace {

template <kind K>
class pack_subdivision {
    using whole_step = static_filter::whole_step<pack, forms_of_kind<K>::template type>;
    static constexpr std::size_t constraints = whole_step::constraints;
    static constexpr std::size_t capacity = 6 * block;

    /// Columns of a part: control values of Y and of each G_i, and their two error bounds.
    static constexpr std::size_t y_column = 0, error_columns = 4 + 5 * constraints;
    static constexpr std::size_t g_column(std::size_t i) { return 4 + 5 * i; }
    using part_queue = query_queue<error_columns + 2, capacity>;

  public:
    std::size_t size() const { return parts_[0].size; }

    void push(const whole_step& whole, const std::uint32_t* ids, lanes some) {
        put_form(parts_[0], whole.forms.y, y_column, some);
        for (std::size_t i = 0; i < constraints; ++i)
            put_form(parts_[0], whole.forms.g[i], g_column(i), some);
        put_errors(parts_[0], whole.errors, some);
        parts_[0].push_ids(ids, some);
    }

    [[gnu::flatten]] void run(const decisions& decided) {
        stage_timer timer(decided.report, stage::subdivision);
        const std::size_t entered = parts_[0].size;
        for (std::uint32_t i = 0; i < entered; ++i) {
            ids_[i] = parts_[0].ids[i];
            parts_[0].ids[i] = i;
            open_[i] = true;
        }
        std::size_t separate = 0, collide = 0;
        for (std::size_t depth = 0; parts_[depth % 2].size > 0; ++depth) {
            part_queue& parts = parts_[depth % 2];
            parts.pop_packs(capacity, [&](std::size_t at, std::size_t count) {
                halve(depth, at, test(depth, at, count, decided, collide));
            });
        }
        // All parts of the remaining queries are excluded.
        for (std::size_t i = 0; i < entered; ++i)
            if (open_[i]) {
                decided.answers[ids_[i]] = outcome::separate;
                ++separate;
            }
        timer.count(entered, separate, collide);
    }

  private:
    /// Tests the parts of one pack. Returns those to be halved.
    lanes test(std::size_t depth, std::size_t at, std::size_t count, const decisions& decided,
               std::size_t& collide) {
        const part_queue& parts = parts_[depth % 2];
        const auto errors = load_errors(parts, at);
        const auto y = load_form<3>(parts, y_column, at);
        pack_mask excluded = static_filter::above(y, errors.y) | static_filter::below(y, errors.y);
        pack_mask collides = static_filter::changes_sign(y, errors.y);
        for (std::size_t i = 0; i < constraints; ++i) {
            const auto g = load_form<4>(parts, g_column(i), at);
            excluded = excluded | static_filter::below(g, errors.g);
            collides = collides & static_filter::above(g, errors.g);
        }
        const std::uint32_t* queries = &parts.ids[at];
        lanes left = first_lanes(count) & ~lanes_of<double>(excluded);
        for (std::size_t i = 0; i < count; ++i)
            if (!open_[queries[i]]) left &= ~(lanes(1) << i);
        if (left == 0) return 0;

        const lanes hits = left & lanes_of<double>(collides);
        for_each_lane(hits, [&](std::uint32_t lane) {
            collide += open_[queries[lane]];  // two parts of a query may be in one pack
            open_[queries[lane]] = false;
            decided.answers[ids_[queries[lane]]] = outcome::collides;
        });
        left &= ~hits;
        lanes hopeless = 0;
        const part_queue& halved = parts_[(depth + 1) % 2];
        if (depth == static_filter::max_depth || halved.size + 2 * width > capacity)
            hopeless = left;
        else if (depth >= static_filter::patient_depth)
            hopeless = left & lanes_of<double>(static_filter::within_error(y, errors.y));
        for_each_lane(hopeless, [&](std::uint32_t lane) { open_[queries[lane]] = false; });
        return left & ~hopeless;
    }

    void halve(std::size_t depth, std::size_t at, lanes some) {
        if (some == 0) return;
        const part_queue& parts = parts_[depth % 2];
        part_queue& halved = parts_[(depth + 1) % 2];
        const std::size_t lefts = count_of(some);  // the right halves follow them
        const auto put_halves = [&](const auto& form, std::size_t column) {
            const auto halves = errbound::roots::halves(form);
            put_form(halved, halves.first, column, some);
            put_form(halved, halves.second, column, some, lefts);
        };
        put_halves(load_form<3>(parts, y_column, at), y_column);
        for (std::size_t i = 0; i < constraints; ++i)
            put_halves(load_form<4>(parts, g_column(i), at), g_column(i));
        const auto errors = load_errors(parts, at);
        put_errors(halved, errors, some);
        put_errors(halved, errors, some, lefts);
        halved.push_ids(&parts.ids[at], some);
        halved.push_ids(&parts.ids[at], some);
    }

    template <int N>
    static errbound::roots::control_values<pack, N> load_form(const part_queue& from,
                                                              std::size_t column, std::size_t at) {
        errbound::roots::control_values<pack, N> c;
        for (int i = 0; i <= N; ++i) c[i] = from.load(column + static_cast<std::size_t>(i), at);
        return c;
    }
    static static_filter::form_errors<pack> load_errors(const part_queue& from, std::size_t at) {
        return {from.load(error_columns, at), from.load(error_columns + 1, at)};
    }
    template <int N>
    static void put_form(part_queue& to, const errbound::roots::control_values<pack, N>& c,
                         std::size_t column, lanes some, std::size_t offset = 0) {
        for (int i = 0; i <= N; ++i)
            to.put(column + static_cast<std::size_t>(i), c[i], some, offset);
    }
    static void put_errors(part_queue& to, const static_filter::form_errors<pack>& errors,
                           lanes some, std::size_t offset = 0) {
        to.put(error_columns, errors.y, some, offset);
        to.put(error_columns + 1, errors.g, some, offset);
    }

    std::array<part_queue, 2> parts_;  ///< the first receives whole steps
    // During a run, ids of parts are indices into these.
    std::uint32_t ids_[capacity];
    bool open_[capacity];  ///< neither decided nor left uncertain
};

}  // namespace
}  // namespace ccd::detail::ERRBOUND_INSTRUCTION_SET
