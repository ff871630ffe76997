// The stress run.
#include "ccd/stress/stress.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <ccd/reference.hpp>
#include <chrono>
#include <limits>
#include <utility>

#include "ccd/batch/threads.hpp"

namespace ccd::stress {
namespace {

using std::chrono::steady_clock;

double seconds_since(steady_clock::time_point start) {
    return std::chrono::duration<double>(steady_clock::now() - start).count();
}

/// The queries of a cell and their truth.
template <class Query>
struct question {
    std::vector<Query> queries;
    std::vector<outcome> truth;  ///< uncertain where coordinates are not finite

    question(const plan& what, const family& f, double knob) {
        const std::size_t count = std::max<std::size_t>(1, what.queries / f.thinning(knob));
        for (std::uint64_t i = 0; i < count; ++i) {
            const points p = make(f, knob, kind_of<Query>, what.seed, i);
            queries.push_back(as_query<Query>(p));
        }
        truth.resize(count);
        tbb::parallel_for(std::size_t{0}, count, [this](std::size_t i) {
            truth[i] = decide_reference(queries[i]).outcome;
        });
    }
};

template <class Query>
cell asked(const plan& what, const subject& who, const decider<Query>& decide,
           const question<Query>& about) {
    std::vector<verdict> said(about.queries.size());
    double fastest = std::numeric_limits<double>::infinity(), elapsed = 0;
    const steady_clock::time_point start = steady_clock::now();
    // At least three passes, since one may be disturbed, but for cells that take long.
    for (int passes = 0;
         passes == 0 || elapsed < what.seconds || (passes < 3 && elapsed < 10 * what.seconds);
         ++passes) {
        const steady_clock::time_point pass = steady_clock::now();
        decide(about.queries, said);
        fastest = std::min(fastest, seconds_since(pass));
        elapsed = seconds_since(start);
    }

    cell out;
    out.queries = said.size();
    out.ns_per_query = fastest * 1e9 / static_cast<double>(said.size());
    for (std::size_t i = 0; i < said.size(); ++i) {
        const outcome truth = about.truth[i], answer = said[i].outcome;
        const bool is_certain = answer != outcome::uncertain;
        out.uncertain += !is_certain;
        if (truth == outcome::uncertain) {
            out.from_not_finite += is_certain;
        } else {
            const bool collides = truth == outcome::collides;
            out.collisions += collides;
            out.false_positives += may_collide(said[i]) && !collides;
            out.false_negatives += !may_collide(said[i]) && collides;
            out.wrong_certain += is_certain && answer != truth;
        }
        if (out.broken) continue;
        if (const auto how = broken_by(who, said[i], truth))
            out.broken = {std::string(*how), i, truth == outcome::collides};
    }
    return out;
}

template <kind K>
void add_cells(const plan& what, const family& f, double knob, std::vector<cell>& cells) {
    const question<typename kind_traits<K>::template query<double>> about(what, f, knob);
    for (std::size_t s = 0; s < what.subjects.size(); ++s) {
        cell c = asked(what, what.subjects[s], what.subjects[s].decide.of<K>(), about);
        c.family = &f;
        c.knob = knob;
        c.kind = K;
        c.subject = s;
        cells.push_back(c);
    }
}

void add_cells(const plan& what, const family& f, double knob, std::vector<cell>& cells) {
    for (const kind which : stored_kinds)
        visit_stored_kind(which, [&]<kind K>() { add_cells<K>(what, f, knob, cells); });
}

}  // namespace

subject subject_of(const method_info& method) {
    const auto one_by_one = [m = method.method](auto queries, std::span<verdict> verdicts) {
        for (std::size_t i = 0; i < queries.size(); ++i) verdicts[i] = decide(m, queries[i]);
    };
    return {std::string(method.name),
            method.may_lose_collisions,
            method.may_report_false_collisions,
            {one_by_one, one_by_one}};
}

std::optional<std::string_view> broken_by(const subject& who, verdict said, outcome truth) {
    if (truth == outcome::uncertain) {
        if (said == verdict{outcome::uncertain, cause::range}) return std::nullopt;
        return said.outcome == outcome::uncertain
                   ? "it said `uncertain` of coordinates that are not finite without cause `range`"
                   : "it answered for coordinates that are not finite";
    }
    const bool promises_nothing = who.may_lose_collisions && who.may_report_false_collisions;
    if (truth == outcome::collides && said.outcome == outcome::separate)
        return who.may_lose_collisions ? std::nullopt
                                       : std::optional<std::string_view>("it lost a collision");
    if (truth == outcome::separate && said.outcome == outcome::collides)
        return promises_nothing
                   ? std::nullopt
                   : std::optional<std::string_view>("it said `collides`, which is wrong");
    if (said.outcome != outcome::uncertain || who.may_report_false_collisions) return std::nullopt;
    if (truth == outcome::separate) return "it reported a false collision, as uncertain";
    return who.may_lose_collisions ? std::nullopt
                                   : std::optional<std::string_view>("it gave no answer");
}

std::vector<cell> run(const plan& what, const progress& show) {
    std::size_t all = 0, done = 0;
    for (const family* f : what.families) all += f->knobs.size();
    std::vector<cell> cells;
    detail::on_threads(what.threads, [&] {
        for (const family* f : what.families) {
            for (const double knob : f->knobs) {
                show(done++, all, *f);
                add_cells(what, *f, knob, cells);
            }
        }
    });
    return cells;
}

}  // namespace ccd::stress
