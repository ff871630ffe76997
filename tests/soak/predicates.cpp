#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <errbound/predicate_batch.hpp>
#include <limits>
#include <random>
#include <string_view>
#include <tuple>
#include <utility>

#include "ccd/lab/queries.hpp"
#include "errbound/support/command_line.hpp"
#include "tests/ccd/exact/audited.hpp"
#include "tests/errbound/predicates/predicate_list.hpp"
#include "tests/soak/parts.hpp"

namespace soak {
namespace {

using errbound::predicate_stage;
using errbound::sign_type;
using predicate_inputs::generator;

constexpr std::uint64_t inputs_per_block = 1 << 11;  // of a predicate and number type
constexpr std::uint64_t thinning = 8;  // one input in this many is decided in all ways

constexpr const char* stage_names[] = {
    "semi-static filter", "static filter", "tracked", "doubles", "short", "word",
    "two words",          "long"};
static_assert(std::size(stage_names) == errbound::predicate_stage_count);

// ---- Signs ----

/// Compares the signs of one predicate with its oracle.
template <class T, class Entry>
class sign_comparison {
    static constexpr std::size_t D = Entry::dimension, N = Entry::count;
    using points = predicate_inputs::points<T, D, N>;

  public:
    sign_comparison(const Entry& entry, std::string name, findings& out)
        : entry_(entry), name_(std::move(name)), out_(out) {}

    void add(const points& p, bool in_all_ways) {
        const sign_type right = predicate_list::right_sign(entry_, p);
        auto& counts = out_.table("signs")[name_];
        ++counts[0];
        counts[1] += right == sign_type::zero;
        out_.stir(static_cast<std::uint64_t>(right));
        std::apply(
            [&](const auto&... q) {
                check("as a whole", p, right, entry_.predicate(q...));
                if (!in_all_ways) return;
                check("with a report", p, right, entry_.predicate(stages_, q...));
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
    /// Decides the inputs chosen for all ways as a batch, and counts the stages.
    void finish() {
        std::vector<sign_type> signs(right_.size());
        std::apply([&](const auto&... q) { errbound::batch_signs(entry_.predicate, signs, q...); },
                   batch_);
        for (std::size_t i = 0; i < signs.size(); ++i) {
            points p;
            for (std::size_t k = 0; k < N; ++k) p[k] = batch_[k][i];
            check("in a batch", p, right_[i], signs[i]);
        }
        auto& counts = out_.table("signs")[name_];
        for (std::size_t k = 0; k < errbound::predicate_stage_count; ++k)
            counts[3 + k] += stages_.decided[k];
    }

  private:
    void check(const char* how, const points& p, sign_type right, sign_type found) {
        if (found == right) return;
        ++out_.table("signs")[name_][2];
        out_.differ({name_ + " " + how + ": sign " + std::to_string(static_cast<int>(found) - 1) +
                     " for " + std::to_string(static_cast<int>(right) - 1) + ":" +
                     predicate_inputs::text_of(p) + "\n"});
    }

    const Entry& entry_;
    std::string name_;
    findings& out_;
    errbound::predicate_report stages_;
    std::array<std::vector<std::array<T, D>>, N> batch_;
    std::vector<sign_type> right_;
};

// ---- Bounds ----

/// The largest share of its bound that an error has reached at these points.
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

/// Moves a coordinate by few or, at times, many units in the last place.
template <class T, std::size_t D, std::size_t N>
void move_one(generator& random, predicate_inputs::points<T, D, N>& p) {
    using predicate_inputs::between;
    constexpr int digits = std::numeric_limits<T>::digits;
    T& x = p[random() % N][random() % D];
    if (x == 0) return;
    const int last = std::ilogb(x) - digits + 1;
    const int place = last + between(random, 0, random() % 4 == 0 ? digits - 2 : 3);
    const T moved = x + std::ldexp(static_cast<T>(random() % 2 == 0 ? 1 : -1), place);
    if (std::isfinite(moved)) x = moved;
}

/// Searches for a violation of the static filter's bound by climbs from inputs of each family.
template <class T, class Entry>
void attack(const Entry& entry, const std::string& name, generator& random, findings& out) {
    constexpr int max_steps = 500, max_vain = 100;  // of a climb
    const auto& families = predicate_inputs::families<T, Entry::dimension, Entry::count>;
    auto& counts = out.table("bounds")[name];
    double largest = 0;
    const auto try_at = [&](const auto& p) {
        const audit a = audited_at<T>(entry, p);
        ++counts[0];
        largest = std::max(largest, a.used);
        if (a.violated) {
            ++counts[1];
            out.differ({name + ": bound violated:" + predicate_inputs::text_of(p) + "\n"});
        }
        return a.used;
    };
    for (std::uint64_t climb = 0; counts[0] < inputs_per_block; ++climb) {
        auto best = families[climb % families.size()].make(
            random, entry.surfaces[climb / families.size() % 2]);
        double most = try_at(best);
        for (int step = 0, vain = 0;
             step < max_steps && vain < max_vain && counts[0] < inputs_per_block; ++step, ++vain) {
            auto next = best;
            move_one(random, next);
            const double used = try_at(next);
            if (used < most || !(used > 0)) continue;
            if (used > most) vain = 0;
            most = used;
            best = next;
        }
    }
    const double constant = static_cast<double>(entry.predicate.template static_constant<T>) /
                            errbound::number_traits<T>::unit_roundoff();
    auto& of_bound = out.table("constants of static filters")[name];
    of_bound = {static_cast<std::uint64_t>(std::llround(1e5 * constant)),
                100'000 * static_cast<std::uint64_t>(entry.constant_of_shewchuk),
                static_cast<std::uint64_t>(std::llround(1000 * largest))};
}

// ---- Blocks ----

template <class T, class Entry>
void compare(const Entry& entry, const char* type, std::uint64_t seed, std::uint64_t block,
             findings& out) {
    const std::string name = std::string(entry.name) + ", " + type;
    generator random(ccd::lab::source_of(name, {seed, block}).bits());
    sign_comparison<T, Entry> signs(entry, name, out);
    const auto& families = predicate_inputs::families<T, Entry::dimension, Entry::count>;
    // Digits of the counter select family and surface, so that each is decided in all ways.
    for (std::uint64_t i = 0; i < inputs_per_block; ++i)
        signs.add(
            families[i % families.size()].make(random, entry.surfaces[i / families.size() % 2]),
            i % thinning == 0);
    signs.finish();
    attack<T>(entry, name, random, out);
}

/// Calls visit(entry) for each predicate whose name contains `name`.
template <class Visit>
void for_each_predicate(const std::string& name, const Visit& visit) {
    const auto one = [&](const auto& entry) {
        if (entry.name.find(name) != std::string_view::npos) visit(entry);
    };
    std::apply([&](const auto&... entry) { (one(entry), ...); }, predicate_list::all);
}

findings empty_findings() {
    findings out{.blocks = 1,
                 .tables = {{"signs", {"inputs", "zero", "wrong"}},
                            {"bounds", {"attempts", "violations"}},
                            {"constants of static filters",
                             {"1e-5 u", "Shewchuk's", "used, per mille"},
                             /*largest*/ true}}};
    auto& columns = out.table("signs").columns;
    columns.insert(columns.end(), std::begin(stage_names), std::end(stage_names));
    return out;
}

}  // namespace

part predicate_part(const std::string& name) {
    part all{.name = "predicates", .unit = "inputs"};
    bool any = false;
    for_each_predicate(name, [&](const auto&) { any = true; });
    if (!any)
        throw errbound::support::usage_error("--predicate is '" + name +
                                             "'; expected a part of the name of a predicate");
    all.count = [](std::uint64_t blocks) { return blocks * inputs_per_block; };
    all.compare_block = [name](std::uint64_t seed, std::uint64_t block) {
        findings out = empty_findings();
        for_each_predicate(name, [&](const auto& entry) {
            compare<float>(entry, "float", seed, block, out);
            compare<double>(entry, "double", seed, block, out);
        });
        return out;
    };
    return all;
}

}  // namespace soak
