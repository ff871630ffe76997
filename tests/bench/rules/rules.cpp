// The cost of each operation under each bound rule, and of explained errors. Plain double and the
// intervals of Boost.Interval, MPFI and arb, if installed, are timed next to them.
#include <errbound/explain/explain.hpp>
#include <errbound/functions.hpp>
#include <errbound/validation/rule_list.hpp>
#include <numeric>
#include <string>

#include "tests/bench/rules/contestants.hpp"

namespace bench {
namespace {

struct plain_operators : operators<double> {
    static void dot(double& r, const double* a, const double* b) {
        r = std::inner_product(a, a + term_count, b, 0.0);
    }
    static void polynomial(double& r, const double* c, double x) {
        r = c[term_count - 1];
        for (std::size_t i = term_count - 1; i-- > 0;) r = r * x + c[i];
    }
    static errbound::sign_type sign(double a) {
        using errbound::sign_type;
        return a > 0 ? sign_type::positive : a < 0 ? sign_type::negative : sign_type::zero;
    }
};

/// All 16 terms, of the same sources in all operands.
struct full_operators : operators<errbound::tracked<double, errbound::affine>> {
    using number = errbound::tracked<double, errbound::affine>;
    static number made(double x, double y) {
        static const std::vector<number> sources = [] {
            std::vector<number> all;
            for (int i = 0; i < 16; ++i) all.push_back(number::within(1.0 / 16, 1e-9));
            return all;
        }();
        number sum = 0;
        for (const number& source : sources) sum += source * number(x);
        return sum * number(y);
    }
};

/// Each operand is a sum of products in separate scopes. All operands have the same scopes.
struct explained_operators
    : operators<errbound::tracked<double, errbound::explained<errbound::tight>>> {
    using number = errbound::tracked<double, errbound::explained<errbound::tight>>;
    static number made(double x, double y) {
        number sum = 0;
        for (int i = 1; i < 32; ++i) {
            const errbound::scope s("product " + std::to_string(i));
            sum += number(x) * number(y);
        }
        return sum;  // has the errors of the products and of the sum
    }
};

std::vector<contestant> all_contestants() {
    std::vector<contestant> all;
    all.push_back(contestant_of<double, plain_operators>("plain double"));
    errbound::for_each_rule(errbound::all_rules(), [&]<class Rule>() {
        using number = errbound::tracked<double, Rule>;
        all.push_back(
            contestant_of<number, operators<number>, errbound::has_division<Rule>>(Rule::name));
    });
    all.push_back(contestant_of<full_operators::number, full_operators>("affine, 16 terms"));
    using explained = explained_operators::number;
    all.push_back(contestant_of<explained>("explained, one source"));
    all.push_back(contestant_of<explained, explained_operators>("explained, 32 sources"));
    all.push_back(boost_interval_contestant());
#ifdef ERRBOUND_HAVE_MPFI
    all.push_back(mpfi_contestant());
#endif
#ifdef ERRBOUND_HAS_ARB
    all.push_back(arb_contestant());
#endif
    return all;
}

void time_operations(bool quick, report& out) {
    const std::vector<contestant> all = all_contestants();
    rows minima, medians, ratios;
    for (std::size_t k = 0; k < operation_count; ++k) {
        std::vector<std::function<void()>> passes;
        for (const contestant& c : all)
            if (c.passes[k]) passes.push_back(c.passes[k]);
        const std::vector<timing> timings = race(passes, quick ? 1 : 15);
        for (rows* const table : {&minima, &medians, &ratios})
            table->push_back({{"operation", operation_names[k]}});
        auto taken = timings.begin();
        for (const contestant& c : all) {
            const bool has = c.passes[k] != nullptr;
            minima.back()[c.name] = has ? row(taken->ns(operands_per_pass)) : row();
            medians.back()[c.name] = has ? row(taken->median_ns(operands_per_pass)) : row();
            ratios.back()[c.name] = has ? row(taken->minimum / timings.front().minimum) : row();
            taken += has;
        }
    }
    out.table("rules", {{"what", "minimum"}},
              "ns per operation, throughput over arrays in the first cache: least of some passes",
              minima);
    out.table("rules", {{"what", "median"}}, "the same, median", medians);
    out.table("rules", {{"what", "ratio"}}, "the least, over plain double's", ratios);
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
    bench::program bench("./run bench --rules",
                         "The cost of each operation under each bound rule.");
    return bench.run(argc, argv, [&](bench::report& out) {
#ifndef ERRBOUND_HAVE_MPFI
        bench::say("built without MPFI (libmpfi-dev)");
#endif
#ifndef ERRBOUND_HAS_ARB
        bench::say("built without arb (libflint-arb-dev)");
#endif
        bench::time_operations(bench.quick, out);
    });
}
