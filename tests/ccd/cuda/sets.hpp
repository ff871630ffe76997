// Batches of queries for tests of device code: difficult families, and stored queries.
#pragma once

#include <ccd/batch.hpp>
#include <ccd/cuda.hpp>
#include <ccd/io/query_file.hpp>
#include <ccd/methods/transform.hpp>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "ccd/cuda/queries.hpp"
#include "tests/support/query_families.hpp"
#include "tests/support/stored_data.hpp"

namespace cuda_sets {

inline ccd::cuda::positions positions_of(const ccd::vertex_rows& rows) {
    using coordinates = ccd::cuda::coordinates<double>;
    return {coordinates::rows(rows.before), coordinates::rows(rows.after), rows.vertices};
}

template <class Pair>
struct batch {
    static constexpr bool of_faces = std::is_same_v<Pair, ccd::vertex_face_pair>;
    using query = ccd::query_of_pair<Pair>;

    std::vector<query> queries;
    std::vector<ccd::point<double>> before, after;
    std::vector<Pair> rows;

    void add(const query& q) {
        const auto v = static_cast<ccd::vertex_index>(before.size());
        rows.push_back({v, v + 1, v + 2, v + 3});
        queries.push_back(q);
        for (const auto& p : points_of(q)) {
            before.push_back(p.t0);
            after.push_back(p.t1);
        }
    }
    std::size_t size() const { return queries.size(); }
    ccd::cuda::positions positions() const { return positions_of({before, after}); }
    ccd::cuda::candidates<Pair> candidates() const {
        return ccd::cuda::candidates<Pair>::rows(rows.data(), size());
    }
};

template <class Pair>
batch<Pair> of_family(const query_families::family& family, std::uint64_t count, std::uint64_t seed,
                      batch<Pair> all = {}) {
    using query_families::kind;
    for (std::uint64_t i = 0; i * family.thinning < count; ++i)
        all.add(query_families::as_query<ccd::query_of_pair<Pair>>(query_families::make(
            family, batch<Pair>::of_faces ? kind::vertex_face : kind::edge_edge, seed, i)));
    return all;
}

template <class Pair>
batch<Pair> of_families(std::uint64_t count, std::uint64_t seed) {
    batch<Pair> all;
    for (const auto& family : query_families::families)
        all = of_family<Pair>(family, count, seed, std::move(all));
    return all;
}

template <class Pair>
batch<Pair> stored(const std::filesystem::path& folder) {
    batch<Pair> all;
    for (const auto& path : stored_data::files_in(folder, ".csv")) {
        const auto file = ccd::io::read_queries(path, std::nullopt, false);
        if (const auto* queries = std::get_if<std::vector<ccd::query_of_pair<Pair>>>(&file.queries))
            for (const auto& q : *queries) all.add(q);
    }
    return all;
}

}  // namespace cuda_sets
