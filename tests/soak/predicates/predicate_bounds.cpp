#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "tests/ccd/exact/audited.hpp"
#include "tests/soak/predicates/predicate_jobs.hpp"

namespace soak {
namespace {

/// How much of its bound an error used up at these points.
template <class T, class Entry, class Points>
audit audited_at(const Entry& entry, const Points& p) {
    auto& state = audit::current();
    state = {.unit = std::min(predicate_list::unit_of(entry, p), 0)};
    std::apply(
        [&](const auto&... q) {
            (void)errbound::filters::conclude(
                entry.predicate.template value<audited_coordinate<T>>(q...));
        },
        p);
    return state;
}

/// A coordinate moved by few or, now and then, many units in the last place.
template <class T, std::size_t D, std::size_t N>
void move_one(predicate_inputs::generator& random, predicate_inputs::points<T, D, N>& p) {
    using predicate_inputs::between;
    constexpr int digits = std::numeric_limits<T>::digits;
    T& x = p[random() % N][random() % D];
    if (x == 0) return;
    const int last = std::ilogb(x) - digits + 1;
    const int place = last + between(random, 0, random() % 4 == 0 ? digits - 2 : 3);
    const T moved = x + std::ldexp(static_cast<T>(random() % 2 == 0 ? 1 : -1), place);
    if (std::isfinite(moved)) x = moved;
}

void add(bound_findings& all, const bound_findings& found) {
    all.attempts += found.attempts;
    all.violations += found.violations;
    all.used = std::max(all.used, found.used);
}

template <class T, class Entry>
bound_findings attack(const Entry& entry, predicate_inputs::generator& random,
                      std::uint64_t attempts) {
    constexpr int max_steps = 500, max_vain = 100;  // of a climb
    const auto& families = predicate_inputs::families<T, Entry::dimension, Entry::count>;
    bound_findings found;
    const auto try_at = [&](const auto& p) {
        const audit a = audited_at<T>(entry, p);
        ++found.attempts;
        found.used = std::max(found.used, a.used);
        if (a.violated && ++found.violations <= 3)
            std::fprintf(stderr, "bound violated:%s\n", predicate_inputs::text_of(p).c_str());
        return a.used;
    };
    for (std::uint64_t climb = 0; found.attempts < attempts; ++climb) {
        auto best = families[climb % families.size()].make(
            random, entry.surfaces[climb / families.size() % 2]);
        double most = try_at(best);
        for (int step = 0, vain = 0;
             step < max_steps && vain < max_vain && found.attempts < attempts; ++step, ++vain) {
            auto next = best;
            move_one(random, next);
            const double used = try_at(next);
            if (used < most || !(used > 0)) continue;
            if (used > most) vain = 0;
            most = used;
            best = next;
        }
    }
    return found;
}

}  // namespace

void attack_bounds(const predicate_run& run,
                   const std::function<void(const bound_findings&)>& show) {
    const auto job = [&]<class T, class Entry>(const Entry& entry) {
        bound_findings found = in_chunks<bound_findings>(
            run, entry.name,
            [&](predicate_inputs::generator& random, std::uint64_t attempts) {
                return attack<T>(entry, random, attempts);
            },
            add);
        found.constant = static_cast<double>(entry.predicate.template static_constant<T>) /
                         errbound::number_traits<T>::unit_roundoff();
        found.constant_of_shewchuk = entry.constant_of_shewchuk;
        return found;
    };
    for_each_predicate(run, job, show);
}

}  // namespace soak
