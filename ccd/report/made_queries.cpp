// Queries that the program makes itself: what a bundled scene lacks.
#include "ccd/report/data_set.hpp"
#include "ccd/report/machine.hpp"
#include "ccd/stress/query_generators.hpp"

namespace ccd::report {
namespace {

namespace generators = query_families::generators;
using query_families::kind;
using query_families::points;
using query_families::source;

struct recipe {
    std::string_view name;
    points (*make)(source& random, kind which);
};
constexpr recipe recipes[] = {
    {"near contact",
     [](source& random, kind which) {
         return generators::jitter(random, generators::near_contact(random, which, 1), 3);
     }},
    {"small integers", [](source& random, kind) { return generators::grid(random, 1); }},
};
constexpr std::uint64_t of_each_kind = 5000;

}  // namespace

std::vector<std::unique_ptr<data_set>> made_data(int threads) {
    std::vector<std::unique_ptr<data_set>> all;
    for (const recipe& r : recipes) {
        auto data = std::make_unique<data_set>();
        data->name = r.name;
        data->origin = origin::made;
        data->fingerprint = fingerprint_of(r.name);  // the program's own stands for the rest
        const auto made = [&r](kind which, std::uint64_t i) {
            source random = query_families::source_of(r.name, {std::uint64_t(which), i});
            return r.make(random, which);
        };
        for (std::uint64_t i = 0; i < of_each_kind; ++i) {
            data->vertex_face_queries.queries.stored.push_back(
                query_families::as_vertex_face(made(kind::vertex_face, i)));
            data->edge_edge_queries.queries.stored.push_back(
                query_families::as_edge_edge(made(kind::edge_edge, i)));
        }
        decide_truth(*data, threads);
        all.push_back(std::move(data));
    }
    return all;
}

}  // namespace ccd::report
