// ./run bench --predicates: ns per call and wrong signs of predicates, next to GMP's integers, and
// to CGAL and Shewchuk's code if they are installed.
#include <algorithm>
#include <errbound/predicate_batch.hpp>
#include <errbound/predicates.hpp>
#include <errbound/predicates/constructed_points.hpp>
#include <stdexcept>
#include <string>
#include <tuple>

#include "tests/bench/predicates/peers.hpp"
#include "tests/errbound/predicates/predicate_list.hpp"

#ifdef ERRBOUND_HAVE_TETGEN
// Shewchuk's code (1997, Adaptive Precision Floating-Point Arithmetic), as TetGen's library has it.
// tetgen.h declares only some of these.
void exactinit(int verbose, int no_exact, int no_filter, double x, double y, double z);
double orient2d(double*, double*, double*);
double orient3d(double*, double*, double*, double*);
double incircle(double*, double*, double*, double*);
double insphere(double*, double*, double*, double*, double*);
#endif

namespace bench {
namespace {

using errbound::predicate_stage;
using errbound::sign_type;
using predicate_inputs::surface;

struct run_options {
    bool quick = false;
    std::string predicate = {};  ///< only predicates whose name contains this

    std::size_t inputs() const { return quick ? 1000 : 100'000; }
    int repeats() const { return quick ? 1 : 5; }
    bool wants(std::string_view name) const {
        return name.find(predicate) != std::string_view::npos;
    }
};

struct input_kind {
    std::string_view name;
    std::size_t family;
    int scale;
};
constexpr int far = 531;  // 1e160
constexpr input_kind input_kinds[] = {{"uniform", 0, 0},
                                      {"near", 1, 0},
                                      {"grid", 2, 0},
                                      {"deep", 3, 0},
                                      {"near, at 1e-160", 1, -far},
                                      {"near, at 1e+160", 1, far}};

/// True for orient2d, orient3d, incircle and insphere, which Shewchuk's code has.
bool is_classic(const auto& entry) {
    return entry.constant_of_shewchuk != 0;
}

/// A double for expressions that evaluate signs.
class plain_double {
  public:
    explicit plain_double(double value) : value_(value) {}
    friend plain_double operator+(plain_double a, plain_double b) {
        return plain_double(a.value_ + b.value_);
    }
    friend plain_double operator-(plain_double a, plain_double b) {
        return plain_double(a.value_ - b.value_);
    }
    friend plain_double operator*(plain_double a, plain_double b) {
        return plain_double(a.value_ * b.value_);
    }
    friend sign_type sign_of(plain_double a) {
        return static_cast<sign_type>((a.value_ > 0) - (a.value_ < 0) + 1);
    }

  private:
    double value_;
};

#ifdef ERRBOUND_HAVE_TETGEN
template <std::size_t D, std::size_t N>
deciding_pass shewchuk_pass(const input_set<D, N>& set) {
    // Without TetGen's own filter, which needs the largest coordinates.
    exactinit(0, 0, 1, 1, 1, 1);
    return set.pass([](const auto&... p) {
        const auto decide = [](auto*... x) {
            if constexpr (N == 3) return ::orient2d(x...);
            if constexpr (N == 5) return ::insphere(x...);
            if constexpr (N == 4 && D == 2) return ::incircle(x...);
            if constexpr (N == 4 && D == 3) return ::orient3d(x...);
        };
        return sign_of(plain_double(decide(const_cast<double*>(p.data())...)));  // only reads
    });
}
#endif

struct peer {
    std::string name;
    deciding_pass decide;
    std::size_t thinning = 1;  ///< slow peers are timed on one input in this many
    bool only_negative = false;
};

template <class Entry, class Set>
peer by_gmp(const Entry& entry, const Set& set) {
    return {"GMP integers", set.pass([&entry](const auto&... p) {
                return predicate_list::right_sign(entry, std::array{p...});
            }),
            10};
}

template <class Entry, class Set>
std::vector<peer> peers(const Entry& entry, const Set& set) {
    constexpr std::size_t D = Entry::dimension;
    std::vector<peer> all{
        {"plain double", set.pass([&entry](const auto&... p) {
             return errbound::filters::conclude(entry.predicate.template value<plain_double>(p...));
         })},
        {"errbound", set.pass(entry.predicate)}};
    if constexpr (have_cgal && (D == 2 || D == 3)) {
        const auto passes = cgal_passes(entry.name, set);
        for (std::size_t k = 0; k < passes.size(); ++k)
            if (passes[k].decide)
                all.push_back(
                    {k == 0 ? "Epick" : "Epeck", passes[k].decide, 1, passes[k].only_negative});
    }
#ifdef ERRBOUND_HAVE_TETGEN
    if constexpr ((D == 2 && Entry::count <= 4) ||
                  (D == 3 && 4 <= Entry::count && Entry::count <= 5))
        if (is_classic(entry)) all.push_back({"Shewchuk", shewchuk_pass(set)});
#endif
    if constexpr (!std::is_same_v<decltype(entry.oracle), int>)
        if (is_classic(entry)) all.push_back(by_gmp(entry, set));
    return all;
}

/// The signs of a peer that differ from errbound's, in per cent; "" for none.
row different(const peer& p, const signs& found, const signs& right) {
    const std::size_t inputs = right.size() / p.thinning;
    std::size_t count = 0;
    for (std::size_t i = 0; i < inputs; ++i)
        count += p.only_negative
                     ? (found[i] == sign_type::negative) != (right[i] == sign_type::negative)
                     : found[i] != right[i];
    return count == 0 ? row("")
                      : row(100 * static_cast<double>(count) / static_cast<double>(inputs));
}

struct tables {
    rows ns, ratios, wrong;
};

template <class Entry>
void add_rows(const Entry& entry, const run_options& o, tables& out) {
    if (!o.wants(entry.name)) return;
    constexpr std::size_t D = Entry::dimension, N = Entry::count;
    for (const input_kind& kind : input_kinds) {
        if (kind.scale != 0 && !is_classic(entry)) continue;
        const input_set<D, N> set(predicate_inputs::families<double, D, N>[kind.family].make,
                                  entry.surfaces[1],
                                  o.inputs() / (is_classic(entry) || o.quick ? 1 : 10), kind.scale);
        signs found(set.size()), right(set.size());
        const std::vector<peer> all = peers(entry, set);
        std::vector<std::function<void()>> passes;
        for (const peer& p : all)
            passes.push_back([&] {
                p.decide(set.size() / p.thinning, found);
                keep(found);
            });
        const auto timings = race(passes, o.repeats());
        all[1].decide(set.size(), right);
        for (rows* const table : {&out.ns, &out.ratios, &out.wrong})
            table->push_back({{"predicate", entry.name}, {"inputs", kind.name}});
        for (std::size_t i = 0; i < all.size(); ++i) {
            const peer& p = all[i];
            p.decide(set.size() / p.thinning, found);
            const auto ns = [&](std::size_t k) {
                return timings[k].ns(set.size() / all[k].thinning);
            };
            out.ns.back()[p.name] = ns(i);
            out.ratios.back()[p.name] = ns(i) / ns(0);
            out.wrong.back()[p.name] = different(p, found, right);
        }
    }
}

void beside_peers(const run_options& o, report& out) {
    tables all;
    const auto add = [&](const auto& entry) { add_rows(entry, o, all); };
    std::apply([&](const auto&... entry) { (add(entry), ...); }, predicate_list::all);
    using namespace errbound;
    const auto of_crossing = [&]<std::size_t D, std::size_t N>(std::string_view name,
                                                               const auto& predicate) {
        add(predicate_list::make_entry<D, N>(name, predicate, 0,
                                             {surface::concurrent, surface::concurrent}));
    };
    of_crossing.operator()<2, 6>("orient2d of a crossing",
                                 with_constructed<line_line, given, given>(errbound::orient2d));
    of_crossing.operator()<2, 7>(
        "incircle of a crossing",
        with_constructed<given, given, given, line_line>(errbound::incircle));
    of_crossing.operator()<2, 9>(
        "distances of two crossings",
        with_constructed<line_line, line_line, given>(compare_distances2d));
    of_crossing.operator()<3, 8>(
        "orient3d of a crossing",
        with_constructed<line_plane, given, given, given>(errbound::orient3d));
    out.table("predicates", {{"what", "ns"}}, "one by one, ns per call", all.ns);
    out.table("predicates", {{"what", "ratio"}}, "the same, over the plain double expression",
              all.ratios);
    out.table("predicates", {{"what", "wrong"}}, "signs that differ from errbound's, %", all.wrong);
}

constexpr const char* stage_names[] = {"semi-static filter", "static filter",  "tracked",
                                       "exact doubles",      "short integers", "word integers",
                                       "two-word integers",  "long integers"};
static_assert(std::size(stage_names) == errbound::predicate_stage_count);

/// The exact stages separately, on coordinates of `bits` bits, with the exponents of their last
/// bits spread evenly over `spread`.
template <class Entry>
void add_exact_rows(const Entry& entry, const run_options& o, rows& table) {
    if (!o.wants(entry.name)) return;
    constexpr std::size_t D = Entry::dimension, N = Entry::count;
    const std::size_t inputs = o.quick ? 200 : 5000;
    struct coordinates {
        int bits, spread;
    };
    constexpr coordinates all[] = {{8, 0},    {20, 0},   {53, 0},    {53, 50},  {53, 100},
                                   {53, 200}, {53, 500}, {53, 1000}, {53, 2000}};
    for (const coordinates c : all) {
        const auto make = [&](predicate_inputs::generator& random, surface) {
            predicate_inputs::points<double, D, N> p;
            for (auto& point : p)
                for (double& x : point) {
                    const double fraction =
                        std::trunc(std::ldexp(predicate_inputs::uniform<double>(random), c.bits));
                    x = std::ldexp(
                        fraction,
                        c.spread / 2 - predicate_inputs::between(random, 0, c.spread) - c.bits);
                }
            return p;
        };
        const input_set<D, N> set(make, entry.surfaces[1], inputs);
        // The first stage that is certain of all inputs.
        signs found(inputs);
        auto stage = predicate_stage::exact_doubles;
        const auto decide = [&] {
            set.pass([&](const auto&... p) { return entry.predicate.by(stage, p...); })(inputs,
                                                                                        found);
            keep(found);
        };
        for (decide(); !std::ranges::all_of(found, errbound::certain); decide())
            stage = static_cast<predicate_stage>(static_cast<int>(stage) + 1);
        const auto timings = race({decide,
                                   [&] {
                                       by_gmp(entry, set).decide(inputs, found);
                                       keep(found);
                                   }},
                                  o.repeats());
        table.push_back({{"predicate", entry.name},
                         {"stage", stage_names[static_cast<std::size_t>(stage)]},
                         {"bits", c.bits},
                         {"exponents_over", c.spread},
                         {"errbound", timings[0].ns(inputs)},
                         {"GMP_integers", timings[1].ns(inputs)},
                         {"errbound/GMP", timings[0].minimum / timings[1].minimum}});
    }
}

template <class Entry>
void add_batch_rows(const Entry& entry, const run_options& o, rows& table) {
    if (!o.wants(entry.name)) return;
    constexpr std::size_t D = Entry::dimension, N = Entry::count;
    // In the processor's caches, and in memory: more than it reads in the time that it computes.
    for (const std::size_t inputs : {std::size_t{512}, std::size_t{100'000}}) {
        const input_set<D, N> set(predicate_inputs::families<double, D, N>[0].make,
                                  entry.surfaces[1], inputs);
        signs single(inputs), batch(inputs), arrays(inputs);
        const auto each_argument = [&](const auto& call) {
            [&]<std::size_t... K>(std::index_sequence<K...>) {
                call(std::integral_constant<std::size_t, K>()...);
            }
            (std::make_index_sequence<N>());
        };
        const auto timings =
            race({[&] { set.pass(entry.predicate)(inputs, single), keep(single); },
                  [&] {
                      each_argument([&](auto... k) {
                          errbound::batch_signs(entry.predicate, batch, set.points[k]...);
                      });
                      keep(batch);
                  },
                  [&] {
                      each_argument([&](auto... k) {
                          errbound::batch_signs(entry.predicate, arrays, set.as_arrays(k)...);
                      });
                      keep(arrays);
                  }},
                 o.repeats());
        if (batch != single || arrays != single)
            throw std::runtime_error(std::string(entry.name) + ": batches and one by one disagree");
        const auto ns = [&](std::size_t i) { return timings[i].ns(inputs); };
        table.push_back({{"predicate", entry.name},
                         {"inputs", inputs},
                         {"one_by_one", ns(0)},
                         {"batch_of_points", ns(1)},
                         {"batch_of_arrays", ns(2)},
                         {"speed-up,_points", ns(0) / ns(1)},
                         {"speed-up,_arrays", ns(0) / ns(2)}});
    }
}

/// Calls add(entry, table) for the classic predicates, which have an oracle.
template <class Add>
rows rows_of_classic(const Add& add) {
    rows all;
    [&]<std::size_t... I>(std::index_sequence<I...>) {
        (add(std::get<I>(predicate_list::all), all), ...);
    }
    (std::make_index_sequence<4>());
    return all;
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
    using namespace bench;
    program line("./run bench --predicates",
                 "Predicates next to others that decide them: ns per call, wrong signs.");
    run_options o;
    line.line.add_option("--predicate", o.predicate, "Only those whose name holds this");
    return line.run(argc, argv, [&](report& out) {
        o.quick = line.quick;
        if (!have_cgal) say("built without CGAL (libcgal-dev)");
#ifndef ERRBOUND_HAVE_TETGEN
        say("built without TetGen (libtet1.5-dev)");
#endif
        beside_peers(o, out);
        out.table("predicates", {{"what", "exact stages"}}, "exact stages separately, ns per call",
                  rows_of_classic([&](const auto& e, rows& all) { add_exact_rows(e, o, all); }));
        out.table("predicates", {{"what", "batches"}}, "in batches, uniform inputs, ns per call",
                  rows_of_classic([&](const auto& e, rows& all) { add_batch_rows(e, o, all); }));
        if (o.wants("constructions")) whole_constructions(o.quick, out);
    });
}
