// The last stage of `exact`: time per query in integers of fixed width and by the reference, over
// the stored queries on which `tight` is uncertain.
//
//   last_stage_bench FILE.csv...     a row per file; times in nanoseconds, each query's least of
//                                    some repetitions
#include <algorithm>
#include <ccd/bsc.hpp>
#include <ccd/io/query_file.hpp>
#include <ccd/reference.hpp>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <vector>

#include "ccd/integers.hpp"

namespace {

struct figures {
    std::size_t queries = 0, uncertain = 0, wrong = 0;
    double mean = 0, most = 0, reference_mean = 0;
};

template <class Decide>
double least_time(const Decide& decide, int repetitions) {
    double least = 1e30;
    for (int k = 0; k < repetitions; ++k) {
        const auto start = std::chrono::steady_clock::now();
        decide();
        const std::chrono::duration<double, std::nano> taken =
            std::chrono::steady_clock::now() - start;
        least = std::min(least, taken.count());
    }
    return least;
}

template <class Query>
figures measure(const std::vector<Query>& all) {
    std::vector<Query> queries;
    for (const auto& q : all)
        if (ccd::decide_bsc<errbound::tight>(q).outcome == ccd::outcome::uncertain)
            queries.push_back(q);
    figures f;
    f.queries = queries.size();
    const auto size = static_cast<double>(std::max<std::size_t>(1, f.queries));
    // The mean over whole passes, free of the clock's own cost.
    f.mean = least_time(
                 [&] {
                     for (const auto& q : queries) {
                         const volatile auto seen = ccd::decide_integers(q).outcome;
                         (void)seen;
                     }
                 },
                 20) /
             size;
    for (const auto& q : queries) {
        ccd::verdict said, right;
        f.most = std::max(f.most, least_time([&] { said = ccd::decide_integers(q); }, 5));
        f.reference_mean += least_time([&] { right = ccd::decide_reference(q); }, 1) / size;
        if (said.outcome == ccd::outcome::uncertain)
            ++f.uncertain;
        else if (said.outcome != right.outcome)
            ++f.wrong;
    }
    return f;
}

}  // namespace

int main(int argc, char** argv) try {
    std::printf("%10s%11s%8s%9s%9s%12s\n", "queries", "uncertain", "wrong", "mean", "most",
                "reference");
    for (int i = 1; i < argc; ++i) {
        const auto file = ccd::io::read_queries(argv[i], std::nullopt, true);
        const figures f = file.kind == ccd::io::query_kind::vertex_face
                              ? measure(file.vertex_face_queries)
                              : measure(file.edge_edge_queries);
        std::printf("%10zu%11zu%8zu%9.0f%9.0f%12.0f  %s\n", f.queries, f.uncertain, f.wrong, f.mean,
                    f.most, f.reference_mean, argv[i]);
    }
    return 0;
} catch (const std::exception& e) {
    std::fprintf(stderr, "last_stage_bench: %s\n", e.what());
    return 1;
}
