// Queries that the program makes itself: what a bundled scene lacks.
#include "ccd/report/measuring/data_set.hpp"
#include "ccd/report/measuring/machine.hpp"
#include "ccd/stress/generators/contacts.hpp"
#include "ccd/stress/generators/coordinates.hpp"

namespace ccd::report {
namespace {

namespace generators = stress::generators;
using stress::points;
using stress::source;

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
        data->queries.for_each([&r]<class Query>(queries_with_truth<Query>& into) {
            constexpr kind which = kind_of<Query>;
            for (std::uint64_t i = 0; i < of_each_kind; ++i) {
                source random = stress::source_of(r.name, {std::uint64_t(which), i});
                into.queries.stored.push_back(stress::as_query<Query>(r.make(random, which)));
            }
        });
        decide_truth(*data, threads);
        all.push_back(std::move(data));
    }
    return all;
}

}  // namespace ccd::report
