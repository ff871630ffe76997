// Queries to rows of points, each once in a chunk.
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <type_traits>

#include "ccd/io/store/store_reader.hpp"
#include "ccd/io/store/store_writer.hpp"

namespace ccd::io {

std::size_t query_packer::hash::operator()(const row& r) const {
    std::uint64_t sum = 0;
    for (const std::uint64_t word : r) {
        sum = (sum ^ word) * 0x9e3779b97f4a7c15u;  // Fibonacci hashing: 2^64 by the golden ratio
        sum ^= sum >> 32;
    }
    return static_cast<std::size_t>(sum);
}

void query_packer::add(const query_file& queries) {
    if (queries.kind() != kind_)
        throw std::invalid_argument("found queries of kind " + std::string(name(queries.kind())) +
                                    ", expected " + std::string(name(kind_)));
    if (queries.truth.has_value() != with_truth_)
        throw std::invalid_argument(with_truth_
                                        ? "found queries without truth, expected some with"
                                        : "found queries with truth, expected some without");
    std::visit(
        [&](const auto& all) {
            for (const auto& query : all) {
                using type = std::remove_cvref_t<decltype(query)>;
                static_assert(sizeof(type) == 4 * sizeof(row) &&
                              std::is_trivially_copyable_v<type>);
                row points[4];
                std::memcpy(points, &query, sizeof query);
                add(points);
            }
        },
        queries.queries);
    if (queries.truth) truth_.insert(truth_.end(), queries.truth->begin(), queries.truth->end());
}

void query_packer::add(const row* points) {
    if (queries_.size() % queries_of_a_chunk == 0) {
        first_point_.push_back(points_.size());
        of_chunk_.clear();
    }
    std::array<std::uint32_t, 4> query;
    for (std::size_t i = 0; i < 4; ++i) {
        for (const std::uint64_t bits : points[i])
            if (!std::isfinite(std::bit_cast<double>(bits)))
                throw std::invalid_argument("found a coordinate that is not finite in query " +
                                            std::to_string(queries_.size()));
        const auto next = static_cast<std::uint32_t>(points_.size() - first_point_.back());
        const auto [place, is_new] = of_chunk_.try_emplace(points[i], next);
        if (is_new) points_.push_back(points[i]);
        query[i] = place->second;
    }
    queries_.push_back(query);
}

std::string query_packer::bytes() const {
    if (queries_.empty()) throw std::runtime_error("found no queries, expected at least one");
    std::vector<std::uint64_t> first_point = first_point_;
    first_point.push_back(points_.size());
    return store_of({.kind = name(kind_),
                     .points = points_.data()->data(),
                     .point_count = points_.size(),
                     .queries = queries_.data()->data(),
                     .query_count = queries_.size(),
                     .first_point = first_point,
                     .truth = truth_});
}

}  // namespace ccd::io
