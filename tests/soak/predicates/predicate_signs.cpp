#include <cstdio>
#include <errbound/predicate_batch.hpp>
#include <utility>

#include "tests/soak/predicates/predicate_jobs.hpp"

namespace soak {
namespace {

using errbound::predicate_stage;
using errbound::sign_type;

/// Of one input in so many, all ways of asking are compared.
constexpr std::uint64_t thinning = 8;

template <class T, class Entry>
class comparison {
    static constexpr std::size_t D = Entry::dimension, N = Entry::count;
    using points = predicate_inputs::points<T, D, N>;

  public:
    comparison(const Entry& entry, sign_findings& found) : entry_(entry), found_(found) {}

    void add(const points& p, bool in_all_ways) {
        const sign_type right = predicate_list::right_sign(entry_, p);
        ++found_.inputs;
        found_.zero += right == sign_type::zero;
        std::apply(
            [&](const auto&... q) {
                const sign_type found = entry_.predicate(q...);
                found_.uncertain += found == sign_type::uncertain;
                check("as a whole", p, right, found);
                if (!in_all_ways) return;
                check("with a report", p, right, entry_.predicate(found_.stages, q...));
                for (std::size_t k = 0; k < errbound::predicate_stage_count; ++k) {
                    const sign_type alone =
                        entry_.predicate.by(static_cast<predicate_stage>(k), q...);
                    if (certain(alone)) check("by one stage", p, right, alone);
                }
                for (std::size_t k = 0; k < N; ++k) batch_[k].push_back(p[k]);
                right_.push_back(right);
            },
            p);
    }
    /// Of those that were added in all ways.
    void compare_batch() {
        std::vector<sign_type> signs(right_.size());
        std::apply([&](const auto&... q) { errbound::batch_signs(entry_.predicate, signs, q...); },
                   batch_);
        for (std::size_t i = 0; i < signs.size(); ++i) {
            points p;
            for (std::size_t k = 0; k < N; ++k) p[k] = batch_[k][i];
            check("in a batch", p, right_[i], signs[i]);
        }
    }

  private:
    void check(const char* how, const points& p, sign_type right, sign_type found) {
        if (found == right) return;
        constexpr std::uint64_t max_shown = 3;  // of a chunk
        if (++found_.wrong <= max_shown)
            std::fprintf(stderr, "wrong %s, %d for %d:%s\n", how, static_cast<int>(found) - 1,
                         static_cast<int>(right) - 1, predicate_inputs::text_of(p).c_str());
    }

    const Entry& entry_;
    sign_findings& found_;
    std::array<std::vector<std::array<T, D>>, N> batch_;
    std::vector<sign_type> right_;
};

void add(sign_findings& all, const sign_findings& found) {
    all.inputs += found.inputs;
    all.zero += found.zero;
    all.wrong += found.wrong;
    all.uncertain += found.uncertain;
    for (std::size_t k = 0; k < errbound::predicate_stage_count; ++k)
        all.stages.decided[k] += found.stages.decided[k];
}

}  // namespace

void compare_signs(const predicate_run& run,
                   const std::function<void(const sign_findings&)>& show) {
    const auto job = [&]<class T, class Entry>(const Entry& entry) {
        return in_chunks<sign_findings>(
            run, entry.name,
            [&](predicate_inputs::generator& random, std::uint64_t inputs) {
                sign_findings found;
                comparison<T, Entry> compare(entry, found);
                const auto& families =
                    predicate_inputs::families<T, Entry::dimension, Entry::count>;
                // Family and surface by the counter's digits, so that each meets all ways.
                for (std::uint64_t i = 0; i < inputs; ++i)
                    compare.add(families[i % families.size()].make(
                                    random, entry.surfaces[i / families.size() % 2]),
                                i % thinning == 0);
                compare.compare_batch();
                return found;
            },
            add);
    };
    for_each_predicate(run, job, show);
}

}  // namespace soak
