#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <ccd/contact.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <tuple>
#include <type_traits>

#include "ccd/batch/batch_worker.hpp"
#include "ccd/batch/checks.hpp"
#include "ccd/batch/chunks.hpp"
#include "ccd/batch/threads.hpp"

namespace ccd::detail {
namespace {

constexpr const char* caller = "ccd::first_times";

batch_options batch_options_of(const time_options& options) {
    return {.threads = options.threads, .set = options.set, .stop = options.stop};
}

template <class Item>
class timed_queries {
  public:
    explicit timed_queries(const timed_batch<Item>& all)
        : input_(all.queries), options_(all.options) {
        check_distances(caller, distances(), any_pair<Item> ? input_.positions.vertices : 0);
        check_t_max(caller, options_.t_max);
        if constexpr (any_query<Item>) (void)kernels_for(options_.set);  // throws if not available
    }
    std::size_t size() const { return input_.items.size(); }
    const time_options& options() const { return options_; }
    auto query(std::size_t i) const { return query_at(input_, i); }
    separation distance(std::size_t i) const {
        if constexpr (any_pair<Item>) return distances().of(input_.items[i]);
        return {distances().all, 0};
    }
    auto batch() const { return batch_of(input_, test()); }
    std::vector<outcome> decisions() const {
        std::vector<outcome> answers(size());
        if (any_pair<Item> || distances().is_contact())
            decide_chunks(batch(), std::span(answers), batch_options_of(options_), test());
        else
            for_each_index(size(), options_.threads, [&](std::size_t i) {
                stop_if_requested(options_.stop);
                answers[i] = decide_within(query(i), distance(i)).outcome;
            });
        return answers;
    }

  private:
    const pair_distances& distances() const { return options_.distances; }
    request test() const {
        return {caller, false, distances().is_contact() ? nullptr : &distances()};
    }

    const batch_input<Item>& input_;
    const time_options& options_;
};

/// Returns the queries that are not separate, without times; answers[0] belongs to query `first`.
/// Most are separate, so eight answers are skipped at once.
std::vector<timed_contact> possible_contacts(std::span<const outcome> answers,
                                             std::size_t first = 0) {
    constexpr std::array<outcome, 8> word{};
    static_assert(outcome{} == outcome::separate && sizeof(word) == 8);
    std::vector<timed_contact> possible;
    const auto take = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            if (answers[i] != outcome::separate) possible.push_back({first + i, {answers[i]}});
    };
    const std::size_t whole = answers.size() - answers.size() % word.size();
    for (std::size_t i = 0; i < whole; i += word.size())
        if (std::memcmp(&answers[i], word.data(), word.size()) != 0) take(i, i + word.size());
    take(whole, answers.size());
    return possible;
}

/// Works in blocks that fit in the first-level cache.
template <class Batch>
void find_times(const batch_worker& worker, const Batch& batch, std::span<timed_contact> some) {
    using item = std::remove_cvref_t<decltype(batch.item(0))>;
    constexpr std::size_t most = 64;
    std::array<item, most> items;
    std::array<first_time, most> times;
    for (std::size_t first = 0; first < some.size(); first += most) {
        const auto block = some.subspan(first, std::min(most, some.size() - first));
        for (std::size_t i = 0; i < block.size(); ++i) items[i] = batch.item(block[i].query);
        batch.find_times(worker, std::span<const item>(items).first(block.size()), times.data());
        for (std::size_t i = 0; i < block.size(); ++i)
            if (block[i].time.outcome == outcome::collides) block[i].time = times[i];
    }
}

void erase_later(std::vector<timed_contact>& contacts, double t_max) {
    std::erase_if(contacts, [t_max](const timed_contact& c) {
        return c.time.outcome == outcome::separate ||
               (c.time.outcome == outcome::collides && c.time.high > t_max);
    });
}

/// Every thread gets several chunks, because a chunk takes milliseconds if all its queries collide.
std::size_t timed_chunk_size(std::size_t queries, int threads) {
    const auto all = static_cast<std::size_t>(threads_of(threads));
    return std::clamp<std::size_t>(queries / (8 * all), 256, chunk_size);
}

/// Computes the times of each chunk while its decisions are in the caches.
template <class Batch>
std::vector<timed_contact> contacts_of_chunks(const Batch& batch, const time_options& options) {
    const std::size_t size = timed_chunk_size(batch.size(), options.threads);
    std::vector<std::vector<timed_contact>> found(batch.size() / size + 1);
    for_each_chunk(batch.size(), size, batch_options_of(options),
                   [&](batch_worker& worker, std::size_t first, std::size_t count) {
                       std::array<outcome, chunk_size> answers;
                       batch.decide(worker, first, count, answers.data());
                       auto& contacts = found[first / size];
                       contacts = possible_contacts(std::span(answers).first(count), first);
                       find_times(worker, batch, contacts);
                       erase_later(contacts, options.t_max);
                   });
    std::size_t number = 0;
    for (const auto& contacts : found) number += contacts.size();
    std::vector<timed_contact> all;
    all.reserve(number);
    for (const auto& contacts : found) all.insert(all.end(), contacts.begin(), contacts.end());
    return all;
}

template <class Item>
std::vector<timed_contact> contacts_among(const timed_queries<Item>& queries) {
    const time_options& options = queries.options();
    if (options.distances.is_contact()) return contacts_of_chunks(queries.batch(), options);
    std::vector<timed_contact> found = possible_contacts(queries.decisions());
    for_each_index(found.size(), options.threads, [&](std::size_t i) {
        stop_if_requested(options.stop);
        auto& [query, time] = found[i];
        time = time_within(queries.query(query), queries.distance(query), options.t_max);
    });
    erase_later(found, options.t_max);
    return found;
}

template <class Item>
std::vector<first_time> all_times(const timed_queries<Item>& queries) {
    const std::vector<timed_contact> contacts = contacts_among(queries);
    std::vector<first_time> times(queries.size(), first_time{outcome::separate});
    for (const timed_contact& c : contacts) times[c.query] = c.time;
    return times;
}

auto order_of(const first_time& time) {
    return std::tuple(time.low, time.high);
}

class earliest_of_thread {
  public:
    void add(const first_time& time, std::size_t query) {
        if (time.at_start()) {
            found_.at_start.push_back(query);
            return;
        }
        const bool is_first = found_.queries.empty();
        if (is_first || order_of(time) < order_of(found_.time)) {
            found_.time = time;
            found_.queries.clear();
        }
        if (order_of(time) == order_of(found_.time)) found_.queries.push_back(query);
    }
    void add(const earliest_of_thread& other) {
        for (const std::size_t query : other.found_.queries) add(other.found_.time, query);
        const auto& more = other.found_.at_start;
        found_.at_start.insert(found_.at_start.end(), more.begin(), more.end());
    }
    earliest_time sorted() && {
        if (found_.queries.empty()) found_.time = {outcome::separate};
        std::ranges::sort(found_.queries);
        std::ranges::sort(found_.at_start);
        return std::move(found_);
    }

  private:
    earliest_time found_;
};

std::optional<earliest_time> only_uncertain(const std::vector<timed_contact>& contacts) {
    std::vector<std::size_t> uncertain;
    for (const auto& [query, time] : contacts)
        if (time.outcome == outcome::uncertain) uncertain.push_back(query);
    if (uncertain.empty()) return std::nullopt;
    return earliest_time{{}, std::move(uncertain), {}};
}

/// Computing a time is cheaper than proving that it is not the minimum.
earliest_time earliest_of_times(const std::vector<timed_contact>& contacts) {
    if (auto uncertain = only_uncertain(contacts)) return *std::move(uncertain);
    earliest_of_thread all;
    for (const auto& [query, time] : contacts) all.add(time, query);
    return std::move(all).sorted();
}

/// True if a decision on [0, t_max] excludes contact there. With M the largest size of a
/// coordinate, std::lerp has an error of at most 2^-50·M + 2^-1072 in every rounding direction.
/// Coordinates of the rounded motion have no larger error. The distance of two points has less than
/// four times that error, which the margin exceeds.
template <class Query>
bool is_certainly_later(const Query& query, separation d, double t_max) {
    constexpr std::size_t count = sizeof(Query) / sizeof(moving_point<double>);
    auto points = std::bit_cast<std::array<moving_point<double>, count>>(query);
    double largest = 0;
    for (moving_point<double>& p : points)
        for (const auto axis : {&point<double>::x, &point<double>::y, &point<double>::z}) {
            const double before = p.t0.*axis, after = p.t1.*axis;
            largest = std::max({largest, std::abs(before), std::abs(after)});
            p.t1.*axis = std::lerp(before, after, t_max);
        }
    const double wider = d.second + (0x1p-47 * largest + 0x1p-1070);
    const separation more{d.first, std::nextafter(wider, std::numeric_limits<double>::infinity())};
    return decide_within(std::bit_cast<Query>(points), more).outcome == outcome::separate;
}

void lower(std::atomic<double>& bound, double value) {
    double now = bound.load();
    while (value < now && !bound.compare_exchange_weak(now, value)) continue;
}

/// `bound` never excludes a query with the earliest time: times are computed up to and including
/// the upper end of the least bracket found.
template <class Item>
earliest_time earliest_of_all(const timed_queries<Item>& queries) {
    if (queries.options().distances.is_contact()) return earliest_of_times(contacts_among(queries));
    const std::vector<timed_contact> contacts = possible_contacts(queries.decisions());
    if (auto uncertain = only_uncertain(contacts)) return *std::move(uncertain);
    std::atomic<double> bound = queries.options().t_max;
    per_thread<earliest_of_thread> parts;
    for_each_index(contacts.size(), queries.options().threads, [&](std::size_t i) {
        stop_if_requested(queries.options().stop);
        const double t_max = bound;
        const std::size_t number = contacts[i].query;
        const auto& query = queries.query(number);
        const separation d = queries.distance(number);
        if (t_max < 1 && is_certainly_later(query, d, std::max(t_max, 0.0))) return;
        const first_time time = time_within(query, d, t_max);
        if (time.outcome != outcome::collides) return;
        if (!time.at_start()) lower(bound, time.high);
        parts.local().add(time, number);
    });
    earliest_of_thread all;
    for (const earliest_of_thread* part : parts.all()) all.add(*part);
    return std::move(all).sorted();
}

}  // namespace

template <class Item>
std::vector<outcome> timed_batch<Item>::decisions() const {
    return timed_queries(*this).decisions();
}
template <class Item>
std::vector<timed_contact> timed_batch<Item>::contacts() const {
    return contacts_among(timed_queries(*this));
}
template <class Item>
std::vector<first_time> timed_batch<Item>::times() const {
    return all_times(timed_queries(*this));
}
template <class Item>
earliest_time timed_batch<Item>::earliest() const {
    return earliest_of_all(timed_queries(*this));
}

template struct timed_batch<vertex_face_pair>;
template struct timed_batch<edge_edge_pair>;
template struct timed_batch<vertex_edge_pair>;
template struct timed_batch<vertex_vertex_pair>;
template struct timed_batch<vertex_face<double>>;
template struct timed_batch<edge_edge<double>>;
template struct timed_batch<vertex_edge<double>>;
template struct timed_batch<vertex_vertex<double>>;

}  // namespace ccd::detail
