#include <ccd/batch.hpp>
#include <ccd/contact.hpp>
#include <vector>

#include "tests/everywhere/sections.hpp"

namespace everywhere {
namespace {

void add_contacts(recorder& to, const std::vector<ccd::timed_contact>& contacts) {
    for (const auto& c : contacts) {
        to.add(c.query);
        to.add(c.time);
    }
}

void add_earliest(recorder& to, const ccd::earliest_time& earliest) {
    to.add(earliest.time);
    to.add(earliest.queries);
    to.add(earliest.at_start);
}

template <ccd::kind K>
struct all_queries {
    using query = typename ccd::kind_traits<K>::template query<double>;
    using pair = typename ccd::kind_traits<K>::pair;

    std::vector<query> stored;
    std::vector<ccd::point<double>> before, after;
    std::vector<pair> pairs;

    /// Each query has separate vertices, so that families that differ by hundreds of powers of two
    /// are in one frame.
    explicit all_queries(std::uint64_t per_family) {
        for (const auto& f : query_families::families)
            for (std::uint64_t i = 0; i * f.thinning < per_family; ++i) {
                const auto points = query_families::make(f, K, 3, i);
                stored.push_back(ccd::lab::as_query<query>(points));
                const auto v = static_cast<ccd::vertex_index>(before.size());
                for (const auto& p : points) {
                    before.push_back(p.t0);
                    after.push_back(p.t1);
                }
                pairs.push_back({v, v + 1, v + 2, v + 3});
            }
    }
};

template <ccd::kind K>
void record_kind(recorder& to, ccd::instruction_set set) {
    const all_queries<K> all(16);
    const ccd::vertex_rows rows(std::span(all.before), std::span(all.after));
    const auto record = [&](const auto&... queries) {
        ccd::batch_options options;
        options.threads = 2;
        options.set = set;
        to.add(ccd::decide_batch(queries..., options).answers);
        to.add(ccd::touches_at_start_batch(queries..., options).answers);
        to.end_item("decisions");
        ccd::time_options timed;
        timed.threads = 2;
        timed.set = set;
        const auto times = ccd::first_times(queries..., timed);
        to.add(times);
        add_contacts(to, ccd::timed_contacts(queries..., timed));
        add_earliest(to, ccd::earliest(queries..., timed));
        to.end_item("times");
        to.add(ccd::first_contacts(queries..., times, 2));
        to.end_item("contacts");
    };
    record(all.stored);
    record(rows, all.pairs);
    ccd::time_options within;
    within.threads = 2;
    within.set = set;
    within.distances.all = 0x1p-20;
    to.add(ccd::decide_within_batch(all.stored, within));
    to.end_item("distances");
}

}  // namespace

void record_batches(recorder& to, ccd::instruction_set set) {
    record_kind<ccd::kind::vertex_face>(to, set);
    record_kind<ccd::kind::edge_edge>(to, set);
}

}  // namespace everywhere
