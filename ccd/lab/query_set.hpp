// Queries of experiments: a step's candidates by index, or stored ones.
#pragma once

#include <algorithm>
#include <ccd/batch.hpp>
#include <ccd/contact.hpp>
#include <ccd/mesh.hpp>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "ccd/io/stored_kinds.hpp"

namespace ccd::lab {

/// Queries in the order in which they are decided: `by_index` into `rows`, which are not owned, or
/// `stored`.
template <class Query>
struct query_set {
    ccd::vertex_rows rows;
    std::vector<pair_of_query<Query>> by_index;
    std::vector<Query> stored;

    std::size_t size() const { return by_index.size() + stored.size(); }
    Query operator[](std::size_t i) const {
        return by_index.empty() ? stored[i] : ccd::query_of(rows, by_index[i]);
    }
    stage_report decide_batch(std::size_t first, std::span<ccd::outcome> answers,
                              const ccd::batch_options& options) const {
        return by_index.empty()
                   ? ccd::decide_batch(std::span(stored).subspan(first, answers.size()), answers,
                                       options)
                   : ccd::decide_batch(rows, std::span(by_index).subspan(first, answers.size()),
                                       answers, options);
    }
    std::vector<timed_contact> timed_contacts(const time_options& options) const {
        return by_index.empty() ? ccd::timed_contacts(stored, options)
                                : ccd::timed_contacts(rows, by_index, options);
    }
    /// `count` queries: drawn evenly if there are more, repeated if there are fewer.
    query_set resized(std::size_t count) const {
        query_set result{.rows = rows, .by_index = {}, .stored = {}};
        const auto draw = [&](const auto& from, auto& to) {
            to.reserve(from.empty() ? 0 : count);
            for (std::size_t i = 0; i < count && !from.empty(); ++i) {
                to.push_back(from[count < from.size() ? i * from.size() / count : i % from.size()]);
            }
        };
        draw(by_index, result.by_index);
        draw(stored, result.stored);
        return result;
    }
    query_set at_most(std::size_t count) const { return size() > count ? resized(count) : *this; }
    std::vector<Query> all_stored() const {
        std::vector<Query> queries;
        queries.reserve(size());
        for (std::size_t i = 0; i < size(); ++i) queries.push_back((*this)[i]);
        return queries;
    }
};

using query_sets = by_stored_kind<query_set>;

}  // namespace ccd::lab
