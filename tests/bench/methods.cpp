#include <algorithm>
#include <ccd/batch.hpp>
#include <ccd/method.hpp>
#include <deque>
#include <stdexcept>

#include "tests/bench/sections.hpp"

namespace bench {
namespace {

/// The number of the sample's queries for one pass of a method. A pass takes at most half a second,
/// estimated from the first queries.
template <class Query>
std::size_t affordable(ccd::method method, const std::vector<Query>& sample) {
    const std::size_t few = std::min<std::size_t>(1000, sample.size());
    const clock::time_point start = clock::now();
    for (std::size_t i = 0; i < few; ++i)
        keep(ccd::decide(method, sample[i * sample.size() / few]));
    const double in_time = 0.5 / seconds_since(start) * static_cast<double>(few);
    return in_time < static_cast<double>(sample.size())
               ? std::max(few, static_cast<std::size_t>(in_time))
               : sample.size();
}

/// Races the contestants on a scene's queries of one kind: every method one by one, and batches.
template <class Query>
class methods_race {
  public:
    methods_race(const query_set<Query>& all, const options& o)
        : all_(all),
          sample_(all.at_most(o.max_queries()).all_stored()),
          batch_(o.quick ? all.at_most(5 * o.max_queries()) : all),
          answers_(batch_.size()) {
        for (const ccd::method_info& m : ccd::methods()) add_method(m);
        for (const ccd::instruction_set set : ccd::instruction_sets())
            add_batch("batch on " + std::string(ccd::name(set)), set, 1);
        const ccd::instruction_set best = ccd::instruction_sets().back();
        const std::string on_best = "batch on " + std::string(ccd::name(best));
        add_batch(on_best + ", all threads", best, 0);
        for (std::size_t i = 0; i < batch_.size(); i += 1 + batch_.size() / o.max_queries())
            if (ccd::decide(ccd::method::exact, batch_[i]).outcome != answers_[i])
                throw std::runtime_error("batches and single calls disagree");
        of_sample_.resize(sample_.size());  // stored: 192 bytes a query
        add_exact(on_best + ", stored queries", of_sample_,
                  [this] { ccd::decide_batch(sample_, of_sample_, {.threads = 1}); });
    }
    methods_race(const methods_race&) = delete;  // the passes refer to it
    methods_race& operator=(const methods_race&) = delete;

    void run(int repeats, rows& table) const {
        const std::vector<timing> timings = race(passes_, repeats);
        for (std::size_t i = 0; i < contestants_.size(); ++i) {
            const contestant& c = contestants_[i];
            const double minimum = timings[i].ns(c.queries);
            table.push_back({{"kind", short_name(ccd::kind_of<Query>)},
                             {"contestant", c.name},
                             {"queries", c.queries},
                             {"collide", c.collisions},
                             {"ns_min", minimum},
                             {"ns_median", timings[i].median_ns(c.queries)},
                             {"speed-up_over_tight",
                              timings[tight_].ns(contestants_[tight_].queries) / minimum}});
        }
    }

  private:
    struct contestant {
        std::string name;
        std::size_t queries, collisions;  ///< uncertain counts as a collision
    };

    void add_method(const ccd::method_info& m) {
        if (m.method == ccd::method::tight) tight_ = contestants_.size();
        const std::size_t size = affordable(m.method, sample_);
        const std::vector<Query>& queries =
            size == sample_.size() ? sample_ : parts_.emplace_back(all_.resized(size).all_stored());
        const auto collisions = std::ranges::count_if(
            queries, [&m](const Query& q) { return ccd::may_collide(ccd::decide(m.method, q)); });
        contestants_.push_back(
            {std::string(m.name), queries.size(), static_cast<std::size_t>(collisions)});
        passes_.push_back([&queries, method = m.method] {
            for (const Query& q : queries) keep(ccd::decide(method, q));
        });
    }
    void add_batch(const std::string& how, ccd::instruction_set set, int threads) {
        const auto before = answers_;
        const bool is_first = contestants_.size() == std::size(ccd::methods());
        add_exact(how, answers_, [this, set, threads] {
            batch_.decide_batch(0, answers_, {.threads = threads, .set = set});
        });
        if (!is_first && answers_ != before) throw std::runtime_error("answers differ: " + how);
    }
    /// Runs the pass once for its answers.
    void add_exact(const std::string& how, const std::vector<ccd::outcome>& answers,
                   const std::function<void()>& pass) {
        pass();
        const auto collisions = std::ranges::count(answers, ccd::outcome::collides);
        contestants_.push_back(
            {"exact, " + how, answers.size(), static_cast<std::size_t>(collisions)});
        passes_.push_back(pass);
    }

    const query_set<Query>& all_;
    std::vector<Query> sample_;
    query_set<Query> batch_;
    std::vector<ccd::outcome> answers_, of_sample_;
    std::deque<std::vector<Query>> parts_;  ///< chunks of the sample, for slow methods
    std::vector<contestant> contestants_;
    std::vector<std::function<void()>> passes_;
    std::size_t tight_ = 0;  ///< index of the tight method
};

}  // namespace

void methods(const scene& s, const options& o, report& out) {
    rows all;
    s.queries.for_each([&]<class Query>(const ccd::lab::queries_with_truth<Query>& known) {
        if (known.queries.size() > 0) methods_race<Query>(known.queries, o).run(o.repeats(), all);
    });
    out.table("methods", {{"scene", s.name}},
              s.name +
                  ": ns per query, one by one (on an even sample where there are fewer) and in "
                  "batches, on one thread by default; last, the speed-up over tight one by one",
              all);
}

}  // namespace bench
