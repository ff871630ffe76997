// ns per call and wrong signs of predicates, compared with GMP's integers, and with CGAL and
// Shewchuk's code if they are installed. The expected signs are those of the tests' oracle in GMP
// integers.
#include "tests/bench/predicates/predicate_peers.hpp"

#include <algorithm>
#include <errbound/integers/binary_double.hpp>
#include <errbound/predicate_batch.hpp>
#include <errbound/predicates.hpp>
#include <errbound/predicates/constructed_points.hpp>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "tests/bench/harness.hpp"
#include "tests/errbound/predicates/predicate_list.hpp"

namespace bench {
namespace {

using errbound::predicate_stage;
using errbound::sign_type;

struct run_options {
    bool quick = false;
    std::string predicate = {};  ///< only predicates whose name contains this

    std::size_t inputs() const { return quick ? 1000 : 100'000; }
    int repeats() const { return quick ? 1 : 5; }
    bool wants(std::string_view name) const {
        return name.find(predicate) != std::string_view::npos;
    }
};

template <class Form>
void decide_plainly(const set_of<Form>& set, std::size_t count, signs& out) {
    for (std::size_t i = 0; i < count; ++i) out[i] = plain_sign(set.with(i, Form()));
}
template <class Form>
void decide_by_errbound(const set_of<Form>& set, std::size_t count, signs& out) {
    for (std::size_t i = 0; i < count; ++i) out[i] = set.with(i, Form::predicate);
}

/// The expression over integers in the unit of the last bit of any coordinate.
template <class Form>
void decide_by_integers(const set_of<Form>& set, std::size_t count, signs& out) {
    for (std::size_t i = 0; i < count; ++i) {
        int unit = std::numeric_limits<int>::max();
        for (const auto& points : set.points)
            for (const double x : points[i])
                unit = std::min(unit, errbound::integers::binary_double(x).last_bit());
        const auto converted = [unit](const auto& point) {
            std::array<big_integer, Form::dimension> q;
            for (std::size_t k = 0; k < Form::dimension; ++k) {
                const errbound::integers::binary_double x(point[k]);
                if (x.magnitude == 0) continue;
                const auto size =
                    static_cast<std::int64_t>(x.magnitude >> std::max(unit - x.exponent, 0));
                q[k] = x.negative ? -size : size;
                q[k] <<= std::max(x.exponent - unit, 0);
            }
            return q;
        };
        out[i] = static_cast<sign_type>(
            1 + sign(set.with(i, [&](const auto&... p) { return Form()(converted(p)...); })));
    }
}
template <class Form>
struct peer {
    std::string_view name;
    decider<Form> decide;      ///< null: not for this predicate, or not installed
    std::size_t thinning = 1;  ///< slow peers are timed on one input in this many
};
template <class Form>
std::vector<peer<Form>> peers() {
    decider<Form> cgal = nullptr, shewchuk = nullptr;
    if constexpr (have_cgal) cgal = decide_by_cgal<Form>;
    if constexpr (have_tetgen) shewchuk = decide_by_shewchuk<Form>;
    return {{"plain double", decide_plainly<Form>},
            {"errbound", decide_by_errbound<Form>},
            {"CGAL", cgal},
            {"Shewchuk", shewchuk},
            {"GMP integers", decide_by_integers<Form>, 10}};
}

struct tables {
    rows ns, ratios, wrong;
};

template <class Form>
signs right_signs(const set_of<Form>& set) {
    constexpr std::size_t D = Form::dimension, N = Form::count;
    const auto& entry = std::get < N == 3 ? 0
                        : D == 3          ? (N == 4 ? 1 : 3)
                                          : 2 > (predicate_list::all);
    signs right(set.size());
    for (std::size_t i = 0; i < set.size(); ++i)
        right[i] = set.with(i, [&](const auto&... p) {
            return predicate_list::right_sign(entry, std::array{p...});
        });
    return right;
}

/// The wrong signs of a peer in per cent; "" for none.
template <class Form>
row wrong_of(const peer<Form>& p, const set_of<Form>& set, const signs& right) {
    const std::size_t inputs = set.size() / p.thinning;
    signs found(set.size());
    p.decide(set, inputs, found);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < inputs; ++i) wrong += found[i] != right[i];
    return wrong == 0 ? row("")
                      : row(100 * static_cast<double>(wrong) / static_cast<double>(inputs));
}

template <class Form>
void add_rows(const run_options& o, tables& out) {
    if (!o.wants(Form::name)) return;
    const auto all = peers<Form>();
    for (const auto& kind : input_kinds) {
        const auto set = make_set<Form>(kind, o.inputs());
        const signs right = right_signs<Form>(set);
        signs found(set.size());
        std::vector<std::function<void()>> passes;
        for (const auto& p : all)
            if (p.decide != nullptr)
                passes.push_back([&] {
                    p.decide(set, set.size() / p.thinning, found);
                    keep(found);
                });
        const auto timings = race(passes, o.repeats());

        for (rows* const table : {&out.ns, &out.ratios, &out.wrong})
            table->push_back({{"predicate", Form::name}, {"inputs", kind.name}});
        auto timing = timings.begin();
        double plain = 0;
        for (const auto& p : all) {
            const std::string name(p.name);
            row ns, ratio, wrong;
            if (p.decide != nullptr) {
                const double each = timing++->ns(set.size() / p.thinning);
                if (plain == 0) plain = each;
                ns = each;
                ratio = each / plain;
                wrong = wrong_of<Form>(p, set, right);
            }
            out.ns.back()[name] = ns;
            out.ratios.back()[name] = ratio;
            out.wrong.back()[name] = wrong;
        }
    }
}

void beside_peers(const run_options& o, report& out) {
    tables all;
    std::apply([&]<class... Form>(const Form&...) { (add_rows<Form>(o, all), ...); }, all_forms);
    out.table("predicates", {{"what", "ns"}}, "one by one, ns per call", all.ns);
    out.table("predicates", {{"what", "ratio"}}, "the same, over the plain double expression",
              all.ratios);
    out.table("predicates", {{"what", "wrong"}}, "wrong signs, %", all.wrong);
}

/// Coordinates of `bits` bits, with the exponents of their last bits spread evenly over `spread`.
template <class Form>
set_of<Form> make_spread_set(int bits, int spread, std::size_t inputs) {
    const auto make = [=](predicate_inputs::generator& random, surface) {
        predicate_inputs::points<double, Form::dimension, Form::count> p;
        for (auto& point : p)
            for (double& x : point) {
                const double fraction =
                    std::trunc(std::ldexp(predicate_inputs::uniform<double>(random), bits));
                x = std::ldexp(fraction,
                               spread / 2 - predicate_inputs::between(random, 0, spread) - bits);
            }
        return p;
    };
    return {make, Form::degenerate, inputs, 0};
}

constexpr const char* stage_names[] = {"semi-static filter", "static filter",  "tracked",
                                       "exact doubles",      "short integers", "word integers",
                                       "two-word integers",  "long integers"};
static_assert(std::size(stage_names) == errbound::predicate_stage_count);

template <class Form, predicate_stage Stage>
void decide_by_stage(const set_of<Form>& set, std::size_t count, signs& out) {
    for (std::size_t i = 0; i < count; ++i)
        out[i] = set.with(i, [](const auto&... p) { return Form::predicate.by(Stage, p...); });
}
template <class Form>
struct exact_stage {
    predicate_stage stage;
    decider<Form> decide;
};
/// The exact stages in the order of their use.
template <class Form>
constexpr auto exact_stages() {
    using enum predicate_stage;
    return std::array<exact_stage<Form>, 5>{
        {{exact_doubles, decide_by_stage<Form, exact_doubles>},
         {short_integers, decide_by_stage<Form, short_integers>},
         {word_integers, decide_by_stage<Form, word_integers>},
         {two_word_integers, decide_by_stage<Form, two_word_integers>},
         {long_integers, decide_by_stage<Form, long_integers>}}};
}

template <class Form>
void add_exact_rows(const run_options& o, rows& table) {
    if (!o.wants(Form::name)) return;
    struct coordinates {
        int bits, spread;
    };
    const std::size_t inputs = o.quick ? 200 : 5000;
    for (const auto [bits, spread] :
         {coordinates{8, 0}, coordinates{20, 0}, coordinates{53, 0}, coordinates{53, 50},
          coordinates{53, 100}, coordinates{53, 200}, coordinates{53, 500}, coordinates{53, 1000},
          coordinates{53, 2000}}) {
        const auto set = make_spread_set<Form>(bits, spread, inputs);
        // The first stage that is certain of all inputs.
        signs found(inputs);
        const auto stages = exact_stages<Form>();
        const auto stage = std::ranges::find_if(stages, [&](const auto& s) {
            s.decide(set, inputs, found);
            return std::ranges::all_of(found, errbound::certain);
        });
        const auto timings =
            race({[&] { stage->decide(set, inputs, found), keep(found); },
                  [&] { decide_by_integers<Form>(set, inputs, found), keep(found); }},
                 o.repeats());
        const auto ns = [&](std::size_t i) { return timings[i].ns(inputs); };
        table.push_back({{"predicate", Form::name},
                         {"stage", stage_names[static_cast<std::size_t>(stage->stage)]},
                         {"bits", bits},
                         {"exponents_over", spread},
                         {"errbound", ns(0)},
                         {"GMP_integers", ns(1)},
                         {"errbound/GMP", ns(0) / ns(1)}});
    }
}

void exact_stages_alone(const run_options& o, report& out) {
    rows all;
    std::apply([&]<class... Form>(const Form&...) { (add_exact_rows<Form>(o, all), ...); },
               all_forms);
    out.table("predicates", {{"what", "exact stages"}}, "exact stages separately, ns per call",
              all);
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

template <class Form>
void add_batch_rows(const run_options& o, rows& table) {
    if (!o.wants(Form::name)) return;
    // In the processor's caches, and in memory: more than it reads in the time that it computes.
    for (const std::size_t inputs : {std::size_t{512}, std::size_t{100'000}}) {
        const auto set = make_set<Form>(input_kinds[0], inputs);
        signs single(inputs), batch(inputs), arrays(inputs);
        const auto timings =
            race({[&] { decide_by_errbound<Form>(set, inputs, single), keep(single); },
                  [&] { in_batch(set, Form::predicate, batch); },
                  [&] { of_arrays(set, Form::predicate, arrays); }},
                 o.repeats());
        if (batch != single || arrays != single)
            throw std::runtime_error(std::string(Form::name) + ": batches and one by one disagree");
        const auto ns = [&](std::size_t i) { return timings[i].ns(inputs); };
        table.push_back({{"predicate", Form::name},
                         {"inputs", inputs},
                         {"one_by_one", ns(0)},
                         {"batch_of_points", ns(1)},
                         {"batch_of_arrays", ns(2)},
                         {"speed-up,_points", ns(0) / ns(1)},
                         {"speed-up,_arrays", ns(0) / ns(2)}});
    }
}

void in_batches(const run_options& o, report& out) {
    rows all;
    std::apply([&]<class... Form>(const Form&...) { (add_batch_rows<Form>(o, all), ...); },
               all_forms);
    out.table("predicates", {{"what", "batches"}}, "in batches, uniform inputs, ns per call", all);
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
    friend sign_type sign_of(plain_double a) { return plain_sign(a.value_); }

  private:
    double value_;
};

double percent_different(const signs& a, const signs& b, bool only_negative) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        count += only_negative ? (a[i] == sign_type::negative) != (b[i] == sign_type::negative)
                               : a[i] != b[i];
    return 100 * static_cast<double>(count) / static_cast<double>(a.size());
}
/// A row of times next to those of CGAL's kernels, as far as they have the predicate.
template <class Entry>
void add_other_row(const Entry& entry, const run_options& o, rows& table) {
    if (!o.wants(entry.name)) return;
    constexpr std::size_t D = Entry::dimension, N = Entry::count;
    row& r = table.emplace_back(row{{"predicate", entry.name}});
    for (std::size_t family = 0; family < 4; ++family) {
        const input_set<D, N> set(predicate_inputs::families<double, D, N>[family].make,
                                  entry.surfaces[1], o.inputs() / (o.quick ? 1 : 10), 0);
        signs plain(set.size()), found(set.size()), theirs(set.size());
        std::vector<std::function<void()>> passes{
            [&] {
                for (std::size_t i = 0; i < set.size(); ++i)
                    plain[i] = set.with(i, [&](const auto&... p) {
                        return errbound::filters::conclude(
                            entry.predicate.template value<plain_double>(p...));
                    });
                keep(plain);
            },
            [&] {
                for (std::size_t i = 0; i < set.size(); ++i)
                    found[i] = set.with(i, entry.predicate);
                keep(found);
            }};
        std::array<cgal_pass, 2> cgal;
        if constexpr (have_cgal && (D == 2 || D == 3)) cgal = cgal_passes(entry.name, set);
        for (const cgal_pass& pass : cgal)
            if (pass.decide) passes.push_back([&] { pass.decide(theirs), keep(theirs); });
        const auto timings = race(passes, o.repeats());
        const std::string name(input_kinds[family].name);
        const auto ns = [&](std::size_t i) { return timings[i].ns(set.size()); };
        r[name + ":_plain"] = ns(0);
        r[name + ":_errbound"] = ns(1);
        r[name + ":_plain_wrong_%"] = percent_different(plain, found, false);
        std::size_t next = 2;
        for (std::size_t k = 0; k < cgal.size(); ++k) {
            const std::string column = name + (k == 0 ? ":_Epick" : ":_Epeck");
            r[column] = cgal[k].decide ? row(ns(next++)) : row("");
            if (!cgal[k].decide) continue;
            cgal[k].decide(theirs);
            r[column + "_differs_%"] = percent_different(theirs, found, cgal[k].only_negative);
        }
    }
}

void without_peers(const run_options& o, report& out) {
    rows all;
    const auto other = [&](const auto& entry) {
        if (entry.constant_of_shewchuk == 0) add_other_row(entry, o, all);
    };
    std::apply([&](const auto&... entry) { (other(entry), ...); }, predicate_list::all);
    using namespace errbound;
    using predicate_list::make_entry;
    const auto with_crossings = [&]<std::size_t D, std::size_t N>(std::string_view name,
                                                                  const auto& predicate) {
        other(make_entry<D, N>(name, predicate, 0, {surface::concurrent, surface::concurrent}));
    };
    with_crossings.operator()<2, 6>("orient2d of a crossing",
                                    with_constructed<line_line, given, given>(orient2d));
    with_crossings.operator()<2, 7>("incircle of a crossing",
                                    with_constructed<given, given, given, line_line>(incircle));
    with_crossings.operator()<2, 9>(
        "distances of two crossings",
        with_constructed<line_line, line_line, given>(compare_distances2d));
    with_crossings.operator()<3, 8>("orient3d of a crossing",
                                    with_constructed<line_plane, given, given, given>(orient3d));
    out.table("predicates", {{"what", "others"}}, "the other predicates, ns per call", all);
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
    bench::program bench("./run bench --predicates",
                         "Predicates next to others that decide them: ns per call, wrong signs.");
    bench::run_options o;
    bench.line.add_option("--predicate", o.predicate, "Only those whose name holds this");
    return bench.run(argc, argv, [&](bench::report& out) {
        o.quick = bench.quick;
        if (!bench::have_cgal) bench::say("built without CGAL (libcgal-dev)");
        if (!bench::have_tetgen) bench::say("built without TetGen (libtet1.5-dev)");
        bench::beside_peers(o, out);
        bench::exact_stages_alone(o, out);
        bench::in_batches(o, out);
        bench::without_peers(o, out);
        if (o.wants("constructions")) bench::whole_constructions(o.quick, out);
    });
}
