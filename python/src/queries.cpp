// Batches of queries, stored or by index: decisions, first times, first contacts.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <ccd/adapters/kept_gap.hpp>
#include <ccd/batch.hpp>
#include <ccd/contact.hpp>
#include <ccd/method.hpp>
#include <ccd/nearness.hpp>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "interruptible.hpp"
#include "results.hpp"

namespace errbound::python {
namespace {

using positions = input<double, -1, 3>;
using numbers = input<double, -1>;

/// Queries of one kind. They, and positions, are the caller's arrays.
class query_input {
  public:
    query_input(const std::string& kind, std::optional<input<double, -1, -1>> stored,
                std::optional<input<std::uint32_t, -1, -1>> pairs, std::optional<positions> before,
                std::optional<positions> after)
        : kind_(kind_named(kind)),
          stored_(std::move(stored)),
          pairs_(std::move(pairs)),
          before_(std::move(before)),
          after_(std::move(after)) {
        if (pairs_) rows_ = {before_->data(), after_->data(), before_->shape(0)};
    }

    template <class Visit>
    auto visit(const Visit& visit) const {
        return ccd::visit_kind(kind_, [&]<ccd::kind K>() {
            using query = typename ccd::kind_traits<K>::template query<double>;
            if (pairs_) return visit(rows_, items_of<ccd::pair_of_kind<K>>(*pairs_));
            return visit(items_of<query>(*stored_));
        });
    }
    std::size_t size() const { return pairs_ ? pairs_->shape(0) : stored_->shape(0); }

  private:
    static ccd::kind kind_named(const std::string& wanted) {
        std::optional<ccd::kind> found;
        ccd::for_each_kind([&]<ccd::kind K>() {
            if (wanted == ccd::kind_traits<K>::name) found = K;
        });
        if (!found) throw std::invalid_argument("kind is '" + wanted + "'; expected a kind");
        return *found;
    }

    ccd::kind kind_;
    std::optional<input<double, -1, -1>> stored_;
    std::optional<input<std::uint32_t, -1, -1>> pairs_;
    std::optional<positions> before_, after_;
    ccd::vertex_rows rows_;
};

nb::tuple decide(const query_input& all, int threads, bool explain, bool at_start) {
    ccd::batch_result result = without_gil([&](const ccd::stop_query& stop) {
        const ccd::batch_options options{.threads = threads, .explain = explain, .stop = stop};
        return all.visit([&](const auto&... queries) {
            return at_start ? ccd::touches_at_start_batch(queries..., options)
                            : ccd::decide_batch(queries..., options);
        });
    });
    const nb::object stages = explain ? nb::object(stages_of(result.stages)) : nb::none();
    return nb::make_tuple(numbers_of<std::uint8_t>(std::move(result.answers)), stages);
}

template <class Query>
concept has_methods = ccd::kind_of<Query>
== ccd::kind::vertex_face || ccd::kind_of<Query> == ccd::kind::edge_edge;

template <class Query>
ccd::outcome decide_one(ccd::method method, const Query& query) {
    if constexpr (has_methods<Query>) return ccd::decide(method, query).outcome;
    throw std::invalid_argument(
        "method: vertex/edge and vertex/vertex queries are decided by 'exact' alone");
}

nb::object decide_by(const query_input& all, const std::string& name) {
    const ccd::method method = method_of(name);
    std::vector<ccd::outcome> answers(all.size());
    in_parts(answers.size(), 4096, [&](std::size_t first, std::size_t count) {
        all.visit([&](const auto& queries, const auto&... pairs) {
            for (std::size_t i = first; i < first + count; ++i)
                if constexpr (sizeof...(pairs) == 0)
                    answers[i] = decide_one(method, queries[i]);
                else
                    answers[i] = decide_one(method, query_of(queries, pairs[i]...));
        });
    });
    return numbers_of<std::uint8_t>(std::move(answers));
}

ccd::time_options time_options_of(double t_max, double distance,
                                  const std::optional<numbers>& thickness, int threads,
                                  const ccd::stop_query& stop) {
    ccd::time_options options{.t_max = t_max, .threads = threads, .stop = stop};
    options.distances.all = distance;
    if (thickness) options.distances.thickness = items_of<double>(*thickness);
    return options;
}

nb::object decide_within(const query_input& all, double distance,
                         const std::optional<numbers>& thickness, int threads) {
    return numbers_of<std::uint8_t>(without_gil([&](const ccd::stop_query& stop) {
        const auto options = time_options_of(1, distance, thickness, threads, stop);
        return all.visit(
            [&](const auto&... queries) { return ccd::decide_within_batch(queries..., options); });
    }));
}

std::vector<ccd::timed_contact> timed(const query_input& all, double t_max, double distance,
                                      const std::optional<numbers>& thickness, int threads) {
    return without_gil([&](const ccd::stop_query& stop) {
        const auto options = time_options_of(t_max, distance, thickness, threads, stop);
        return all.visit(
            [&](const auto&... queries) { return ccd::timed_contacts(queries..., options); });
    });
}

nb::dict times_among(std::vector<ccd::timed_contact>&& contacts) {
    const shared_items<ccd::timed_contact> shared(std::move(contacts));
    nb::dict found;
    found["query"] = shared.column(shared.first().query);
    found["outcome"] =
        shared.column(reinterpret_cast<const std::uint8_t&>(shared.first().time.outcome));
    found["low"] = shared.column(shared.first().time.low);
    found["high"] = shared.column(shared.first().time.high);
    return found;
}

nb::dict first_times(const query_input& all, double t_max, double distance,
                     const std::optional<numbers>& thickness, int threads) {
    return times_among(timed(all, t_max, distance, thickness, threads));
}

/// Returns compute(times, queries or positions and pairs), one Result for each contact, in parts.
template <class Result, class Compute>
std::vector<Result> at_contacts(const query_input& all,
                                const std::vector<ccd::timed_contact>& contacts,
                                const Compute& compute) {
    std::vector<Result> found(contacts.size());
    in_parts(contacts.size(), 65536, [&](std::size_t first, std::size_t count) {
        std::vector<ccd::first_time> times;
        for (std::size_t i = first; i < first + count; ++i) times.push_back(contacts[i].time);
        const auto chosen = [&](const auto& items) {
            std::vector<std::ranges::range_value_t<decltype(items)>> some;
            for (std::size_t i = first; i < first + count; ++i)
                some.push_back(items[contacts[i].query]);
            return some;
        };
        const auto data = all.visit([&](const auto& queries, const auto&... pairs) {
            if constexpr (sizeof...(pairs) == 0)
                return compute(times, chosen(queries));
            else
                return compute(times, queries, chosen(pairs)...);
        });
        std::copy(data.begin(), data.end(), found.begin() + static_cast<std::ptrdiff_t>(first));
    });
    return found;
}

nb::dict first_contacts(const query_input& all, double t_max, int threads) {
    std::vector<ccd::timed_contact> contacts = timed(all, t_max, 0, std::nullopt, threads);
    const shared_items shared(at_contacts<ccd::first_contact>(
        all, contacts, [threads](const auto& times, const auto&... queries) {
            return ccd::first_contacts(queries..., times, threads);
        }));
    nb::dict found = times_among(std::move(contacts));
    add_contacts(found, shared, shared.first());
    return found;
}

nb::dict time_derivatives(const query_input& all, double t_max, int threads) {
    std::vector<ccd::timed_contact> contacts = timed(all, t_max, 0, std::nullopt, threads);
    const shared_items shared(at_contacts<ccd::time_derivative>(
        all, contacts, [threads](const auto& times, const auto&... queries) {
            const auto data = ccd::first_contacts(queries..., times, threads);
            return ccd::time_derivatives(queries..., data, threads);
        }));
    nb::dict found = times_among(std::move(contacts));
    const auto& by = shared.first().by;
    static_assert(sizeof by == 24 * sizeof(double));
    found["derivative"] = shared.columns(&by[0].t0.x, 24);
    found["error"] = shared.column(shared.first().error);
    return found;
}

/// At one time, or at a time for each query.
nb::dict nearness(const query_input& all, double t, const std::optional<numbers>& times,
                  int threads) {
    std::vector<ccd::first_time> at;
    if (times)
        for (const double time : items_of<double>(*times))
            at.push_back({ccd::outcome::collides, time, time});
    return nearness_of(without_gil([&](const ccd::stop_query& stop) {
        const ccd::nearness_options options{.t = t, .threads = threads, .stop = stop};
        return all.visit([&](const auto&... queries) {
            return times ? ccd::nearnesses(queries..., at, options)
                         : ccd::nearnesses(queries..., options);
        });
    }));
}

bool is_counted(const nb::object& counts, std::size_t query) {
    if (counts.is_none()) return true;
    const nb::gil_scoped_acquire held;
    return nb::cast<bool>(counts(query));
}

/// Returns the least time in [0, t_max] of a narrow phase that keeps a gap, over queries with
/// counts(query), or infinity. counts is called only for queries with an earlier time than before.
double least_time(const query_input& all, double min_distance, double rescaling, double max_gap,
                  double t_max, const nb::object& counts) {
    const ccd::adapters::detail::kept_gap kept{rescaling, max_gap};
    double least = std::numeric_limits<double>::infinity();
    const auto shorten = [&](std::size_t i, const auto& query) {
        const auto found =
            ccd::adapters::detail::answer(query, kept, min_distance, std::min(t_max, least));
        if (found.collides && found.toi < least && is_counted(counts, i)) least = found.toi;
    };
    in_parts(all.size(), 4096, [&](std::size_t first, std::size_t count) {
        all.visit([&](const auto& queries, const auto&... pairs) {
            for (std::size_t i = first; i < first + count; ++i)
                if constexpr (sizeof...(pairs) == 0)
                    shorten(i, queries[i]);
                else
                    shorten(i, query_of(queries, pairs[i]...));
        });
    });
    return least;
}

nb::list methods() {
    nb::list all;
    for (const ccd::method_info& m : ccd::methods())
        all.append(nb::make_tuple(std::string(m.name), m.may_lose_collisions,
                                  m.may_report_false_collisions, std::string(m.promise),
                                  std::string(m.source)));
    return all;
}

nb::list instruction_sets() {
    nb::list names;
    for (const ccd::instruction_set set : ccd::instruction_sets())
        names.append(std::string(ccd::name(set)));
    return names;
}

}  // namespace

void bind_queries(nb::module_& m) {
    nb::class_<query_input>(m, "Queries")
        .def(nb::init<const std::string&, std::optional<input<double, -1, -1>>,
                      std::optional<input<std::uint32_t, -1, -1>>, std::optional<positions>,
                      std::optional<positions>>(),
             nb::arg("kind"), nb::arg("stored").none(), nb::arg("pairs").none(),
             nb::arg("before").none(), nb::arg("after").none())
        .def("decide", decide, nb::arg("threads"), nb::arg("explain"), nb::arg("at_start"))
        .def("decide_by", decide_by, nb::arg("method"))
        .def("decide_within", decide_within, nb::arg("distance"), nb::arg("thickness").none(),
             nb::arg("threads"))
        .def("first_times", first_times, nb::arg("t_max"), nb::arg("distance"),
             nb::arg("thickness").none(), nb::arg("threads"))
        .def("first_contacts", first_contacts, nb::arg("t_max"), nb::arg("threads"))
        .def("time_derivatives", time_derivatives, nb::arg("t_max"), nb::arg("threads"))
        .def("nearness", nearness, nb::arg("t"), nb::arg("times").none(), nb::arg("threads"))
        .def("least_time", least_time, nb::arg("min_distance"), nb::arg("rescaling"),
             nb::arg("max_gap"), nb::arg("t_max"), nb::arg("counts").none());
    m.def("methods", methods);
    m.def("instruction_sets", instruction_sets);
}

}  // namespace errbound::python
