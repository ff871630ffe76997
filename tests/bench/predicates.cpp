#include <array>
#include <cmath>
#include <errbound/predicate_batch.hpp>
#include <errbound/predicates.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "sections.hpp"
#include "tests/predicate_inputs.hpp"

namespace bench {
namespace {

using predicate_inputs::surface;
namespace forms = errbound::forms;

/// A predicate next to its expression in plain double.
template <std::size_t Dimension, std::size_t Count, class Predicate, class Plain>
struct contestant {
    static constexpr std::size_t dimension = Dimension, count = Count;
    std::string name;
    surface degenerate;
    Predicate predicate;
    Plain plain;
};
template <std::size_t Dimension, std::size_t Count, class Predicate, class Plain>
contestant<Dimension, Count, Predicate, Plain> make_contestant(const char* name, surface s,
                                                               Predicate predicate, Plain plain) {
    return {name, s, predicate, plain};
}

const auto contestants = std::tuple(
    make_contestant<2, 3>(
        "orient2d", surface::flat, errbound::orient2d,
        [](const auto& a, const auto& b, const auto& c) { return forms::area(a, b, c); }),
    make_contestant<3, 4>("orient3d", surface::flat, errbound::orient3d,
                          [](const auto& a, const auto& b, const auto& c, const auto& d) {
                              return forms::volume(a, b, c, d);
                          }),
    make_contestant<2, 4>("incircle", surface::round, errbound::incircle,
                          [](const auto& a, const auto& b, const auto& c, const auto& d) {
                              return forms::lifted_area(a, b, c, d, forms::unweighted);
                          }),
    make_contestant<3, 5>(
        "insphere", surface::round, errbound::insphere,
        [](const auto& a, const auto& b, const auto& c, const auto& d, const auto& e) {
            return forms::lifted_volume(a, b, c, d, e, forms::unweighted);
        }));

/// Inputs as ranges of points, one for each argument.
template <std::size_t D, std::size_t N>
struct input_set {
    std::array<std::vector<std::array<double, D>>, N> points;
    std::array<std::array<std::vector<double>, D>, N> arrays;

    template <class Make>
    input_set(const Make& make, surface s, std::size_t count, int scale) {
        predicate_inputs::generator random(3);
        for (std::size_t i = 0; i < count; ++i) {
            const auto p = make(random, s);
            for (std::size_t k = 0; k < N; ++k) {
                points[k].emplace_back();
                for (std::size_t d = 0; d < D; ++d) {
                    points[k].back()[d] = std::ldexp(p[k][d], scale);
                    arrays[k][d].push_back(points[k].back()[d]);
                }
            }
        }
    }
    std::size_t size() const { return points[0].size(); }
    errbound::coordinate_arrays<double, D> as_arrays(std::size_t argument) const {
        errbound::coordinate_arrays<double, D> a{{}, size()};
        for (std::size_t d = 0; d < D; ++d) a.coordinates[d] = arrays[argument][d].data();
        return a;
    }
    /// call(points of input i)
    template <class Call>
    auto with(std::size_t i, const Call& call) const {
        return [&]<std::size_t... K>(std::index_sequence<K...>) {
            return call(points[K][i]...);
        }
        (std::make_index_sequence<N>());
    }
};

using signs = std::vector<errbound::sign_type>;

template <class Set, class Plain>
void plainly(const Set& set, const Plain& plain, signs& out) {
    for (std::size_t i = 0; i < set.size(); ++i) {
        const double x = set.with(i, plain);
        out[i] = static_cast<errbound::sign_type>((x > 0) - (x < 0) + 1);
    }
    keep(out);
}
template <class Set, class Predicate>
void one_by_one(const Set& set, const Predicate& predicate, signs& out) {
    for (std::size_t i = 0; i < set.size(); ++i) out[i] = set.with(i, predicate);
    keep(out);
}
template <class Set, class Predicate>
void in_batch(const Set& set, const Predicate& predicate, signs& out) {
    [&]<std::size_t... K>(std::index_sequence<K...>) {
        errbound::batch_signs(predicate, out, set.points[K]...);
    }
    (std::make_index_sequence<std::tuple_size_v<decltype(set.points)>>());
    keep(out);
}
template <class Set, class Predicate>
void of_arrays(const Set& set, const Predicate& predicate, signs& out) {
    [&]<std::size_t... K>(std::index_sequence<K...>) {
        errbound::batch_signs(predicate, out, set.as_arrays(K)...);
    }
    (std::make_index_sequence<std::tuple_size_v<decltype(set.points)>>());
    keep(out);
}

template <class Contestant>
void add_single_rows(const Contestant& c, const options& o, std::vector<std::vector<cell>>& rows) {
    constexpr std::size_t D = Contestant::dimension, N = Contestant::count;
    const std::size_t inputs = o.quick ? 10'000 : 100'000;
    struct input_kind {
        std::string name;
        std::size_t family;
        int scale;
    };
    constexpr int far = 531;  // 1e160
    for (const auto& kind :
         {input_kind{"uniform", 0, 0}, input_kind{"near", 1, 0}, input_kind{"grid", 2, 0},
          input_kind{"deep", 3, 0}, input_kind{"near, at 1e-160", 1, -far},
          input_kind{"near, at 1e+160", 1, far}}) {
        const input_set<D, N> set(predicate_inputs::families<double, D, N>[kind.family].make,
                                  c.degenerate, inputs, kind.scale);
        signs plain(inputs), exact(inputs);
        const auto timings = race(
            {[&] { plainly(set, c.plain, plain); }, [&] { one_by_one(set, c.predicate, exact); }},
            o.repeats());
        errbound::predicate_report stages;
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < inputs; ++i) {
            set.with(i, [&](const auto&... p) { return c.predicate(stages, p...); });
            wrong += plain[i] != exact[i];
        }
        const auto all = static_cast<double>(inputs);
        const auto ns = [all](const timing& t) { return 1e9 * t.minimum / all; };
        rows.push_back({word(c.name), word(kind.name), number(ns(timings[0]), 2),
                        number(ns(timings[1]), 2),
                        number(timings[1].minimum / timings[0].minimum, 2),
                        percent(static_cast<double>(wrong) / all)});
        for (const std::uint64_t decided : stages.decided)
            rows.back().push_back(percent(static_cast<double>(decided) / all));
    }
}

template <class Contestant>
void add_batch_rows(const Contestant& c, const options& o, std::vector<std::vector<cell>>& rows) {
    constexpr std::size_t D = Contestant::dimension, N = Contestant::count;
    // In the processor's caches, and in memory: more than it reads in the time that it computes.
    for (const std::size_t inputs : {std::size_t{512}, std::size_t{100'000}}) {
        const input_set<D, N> set(predicate_inputs::families<double, D, N>[0].make, c.degenerate,
                                  inputs, 0);
        signs single(inputs), batch(inputs), arrays(inputs);
        const auto timings = race({[&] { one_by_one(set, c.predicate, single); },
                                   [&] { in_batch(set, c.predicate, batch); },
                                   [&] { of_arrays(set, c.predicate, arrays); }},
                                  o.repeats());
        if (batch != single || arrays != single)
            throw std::runtime_error(c.name + ": batches and one by one disagree");
        const auto ns = [&](const timing& t) {
            return number(1e9 * t.minimum / static_cast<double>(inputs), 2);
        };
        rows.push_back({word(c.name), count(inputs), ns(timings[0]), ns(timings[1]), ns(timings[2]),
                        number(timings[0].minimum / timings[1].minimum, 2),
                        number(timings[0].minimum / timings[2].minimum, 2)});
    }
}

}  // namespace

void predicates(const options& o, report& out) {
    std::vector<std::vector<cell>> rows;
    std::apply([&](const auto&... c) { (add_single_rows(c, o, rows), ...); }, contestants);
    out.table("predicates", {{"how", "one by one"}},
              "predicates one by one, ns per call, and the stages that decided",
              {{"predicate", "predicate", true},
               {"inputs", "inputs", true},
               {"ns_plain", "plain double"},
               {"ns_exact", "errbound"},
               {"ratio", "ratio"},
               {"plain_wrong", "plain wrong"},
               {"semi_static_filter", "semi-static filter"},
               {"static_filter", "static filter"},
               {"tracked", "tracked"},
               {"exact_doubles", "exact doubles"},
               {"short_integers", "short integers"},
               {"word_integers", "one word"},
               {"two_word_integers", "two words"},
               {"long_integers", "long"}},
              rows);
    rows.clear();
    std::apply([&](const auto&... c) { (add_batch_rows(c, o, rows), ...); }, contestants);
    out.table("predicates", {{"how", "batches"}},
              "predicates in batches, uniform inputs, ns per call",
              {{"predicate", "predicate", true},
               {"inputs", "inputs"},
               {"ns_single", "one by one"},
               {"ns_points", "batch of points"},
               {"ns_arrays", "batch of arrays"},
               {"speedup_points", "speed-up, points"},
               {"speedup_arrays", "speed-up, arrays"}},
              rows);
}

}  // namespace bench
