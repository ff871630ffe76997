#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <ccd/mesh.hpp>
#include <cstddef>
#include <span>

namespace ccd {

std::vector<edge> unique_edges(const std::vector<face>& faces) {
    index last = 0;
    for (const face& f : faces) last = std::max({last, f[0], f[1], f[2]});
    // Edges go to buckets by their lower vertices, which leaves only short runs to sort.
    unsigned shift = 0;
    while (last >> shift > faces.size()) ++shift;
    std::vector<std::size_t> bucket_end((last >> shift) + 2);
    const auto for_each_edge = [&faces](const auto& visit) {
        for (const face& f : faces)
            for (std::size_t k = 0; k < 3; ++k) {
                const index v = f[k], w = f[(k + 1) % 3];
                if (v != w) visit(edge{std::min(v, w), std::max(v, w)});
            }
    };
    for_each_edge([&](const edge& e) { ++bucket_end[(e[0] >> shift) + 1]; });
    for (std::size_t b = 1; b < bucket_end.size(); ++b) bucket_end[b] += bucket_end[b - 1];

    std::vector<edge> edges(bucket_end.back());
    for_each_edge([&](const edge& e) { edges[bucket_end[e[0] >> shift]++] = e; });
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, bucket_end.size() - 1, 1024),
        [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t b = range.begin(); b < range.end(); ++b) {
                const std::size_t begin = b == 0 ? 0 : bucket_end[b - 1];
                std::ranges::sort(std::span(edges).subspan(begin, bucket_end[b] - begin));
            }
        });
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    edges.shrink_to_fit();
    return edges;
}

}  // namespace ccd
