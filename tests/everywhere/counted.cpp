// The program errbound_counted_queries: repeats batches of queries for ./run everywhere
// --instructions, which counts the instructions that an emulator executes for one more call.
//
//   errbound_counted_queries FAMILY CALLS   256 vertex/face and 256 edge/edge queries of a family,
//                                           one thread, the architecture's baseline kernels
#include <ccd/batch.hpp>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <vector>

#include "tests/support/query_families.hpp"

namespace {

constexpr std::uint64_t queries_of_a_kind = 256;

template <ccd::kind K>
auto queries_of(const query_families::family& family) {
    using query = typename ccd::kind_traits<K>::template query<double>;
    std::vector<query> queries;
    for (std::uint64_t i = 0; i < queries_of_a_kind; ++i)
        queries.push_back(ccd::lab::as_query<query>(query_families::make(family, K, 7, i)));
    return queries;
}

std::size_t collisions(const auto& queries) {
    ccd::batch_options options;
    options.threads = 1;
    options.set = ccd::instruction_set::baseline;
    std::size_t found = 0;
    for (const ccd::outcome answer : ccd::decide_batch(queries, options).answers)
        found += answer == ccd::outcome::collides;
    return found;
}

int decide_all(const query_families::family& family, int calls) {
    const auto vertex_face = queries_of<ccd::kind::vertex_face>(family);
    const auto edge_edge = queries_of<ccd::kind::edge_edge>(family);
    std::size_t found = 0;
    for (int i = 0; i < calls; ++i) found += collisions(vertex_face) + collisions(edge_edge);
    std::printf("%zu queries, %zu collisions\n",
                std::size_t(calls) * (vertex_face.size() + edge_edge.size()), found);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    int calls = 0;
    if (argc == 3 && std::from_chars(argv[2], argv[2] + std::strlen(argv[2]), calls).ptr ==
                         argv[2] + std::strlen(argv[2]))
        for (const auto& family : query_families::families)
            if (family.name == argv[1] && calls > 0) return decide_all(family, calls);
    std::fprintf(stderr, "usage: errbound_counted_queries FAMILY CALLS\n");
    return 2;
}
