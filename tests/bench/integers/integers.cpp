// Operations of errbound::integer next to Boost's cpp_int and, if installed, GMP's integers as
// Boost wraps them: ns of each, by numbers of words.
#include <boost/multiprecision/cpp_int.hpp>
#include <cstdint>
#include <errbound/integers/integer.hpp>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "tests/bench/harness.hpp"
#ifdef ERRBOUND_HAVE_GMP
#include <boost/multiprecision/gmp.hpp>
#endif

namespace {

namespace mp = boost::multiprecision;
using boost_integer = mp::number<mp::cpp_int_backend<>, mp::et_off>;

/// Numbers of `words` words, of twice as many, and of one.
template <class Integer>
struct numbers {
    static constexpr std::size_t count = 32;
    std::vector<Integer> a, b, doubled, word, results;

    explicit numbers(int words) : results(count) {
        std::mt19937_64 random(1);
        const auto any = [&random](int size) {
            Integer x = 0;
            for (int i = 0; i < size; ++i) {
                x <<= 64U;
                x += Integer(static_cast<std::uint64_t>(random() | std::uint64_t(i == 0)));
            }
            return Integer(random() % 2 == 0 ? x : Integer(-x));
        };
        for (std::size_t i = 0; i < count; ++i) {
            a.push_back(any(words));
            b.push_back(any(words));
            doubled.push_back(any(2 * words));
            word.push_back(any(1));
        }
    }
    /// A pass of the operation over all pairs; it owns the numbers.
    template <class Operation>
    static std::function<void()> pass(std::shared_ptr<numbers> of, const Operation& operation) {
        return [of, operation] {
            for (std::size_t i = 0; i < count; ++i) operation(*of, i);
            bench::keep(of->results);
        };
    }
};

struct operation {
    std::string name;
    std::function<std::function<void()>(int words)> by_errbound, by_boost, by_gmp;
};

template <class Integer, class Operation>
std::function<std::function<void()>(int)> pass_of(const Operation& operation) {
    return [operation](int words) {
        return numbers<Integer>::pass(std::make_shared<numbers<Integer>>(words), operation);
    };
}
template <class Operation>
operation named(const std::string& name, const Operation& of) {
    return {name, pass_of<errbound::integer>(of), pass_of<boost_integer>(of),
#ifdef ERRBOUND_HAVE_GMP
            pass_of<mp::number<mp::gmp_int, mp::et_off>>(of)
#else
            {}
#endif
    };
}

std::vector<operation> all_operations() {
    return {
        named("copy", [](auto& n, std::size_t i) { n.results[i] = n.a[i]; }),
        named("sum", [](auto& n, std::size_t i) { n.results[i] = n.a[i] + n.b[i]; }),
        named("difference and sum in place",
              [](auto& n, std::size_t i) {
                  n.results[i] -= n.a[i];
                  n.results[i] += n.b[i];
              }),
        named("product", [](auto& n, std::size_t i) { n.results[i] = n.a[i] * n.b[i]; }),
        named("product by a word in place",
              [](auto& n, std::size_t i) {
                  auto& term = n.results[i];
                  term = n.a[i];
                  term *= n.word[i];
              }),
        named("square in place",
              [](auto& n, std::size_t i) {
                  auto& r = n.results[i];
                  r = n.a[i];
                  r *= r;
              }),
        named("quotient", [](auto& n, std::size_t i) { n.results[i] = n.doubled[i] / n.b[i]; }),
        named("remainder", [](auto& n, std::size_t i) { n.results[i] = n.doubled[i] % n.b[i]; }),
        named("shifts",
              [](auto& n, std::size_t i) {
                  n.results[i] = n.a[i] << 75U;
                  n.results[i] >>= 70U;
              }),
        named("order",
              [](auto& n, std::size_t i) {
                  bench::keep(n.a[i] < n.b[i]);
                  bench::keep(n.a[i] == n.a[i]);
                  bench::keep(n.a[i] > 0);
              }),
        named("common divisor", [](auto& n, std::size_t i) { n.results[i] = gcd(n.a[i], n.b[i]); }),
        named("to double",
              [](auto& n, std::size_t i) { bench::keep(static_cast<double>(n.a[i])); }),
    };
}

void run(bool quick, bench::report& out) {
    bench::rows all;
    for (const operation& op : all_operations()) {
        for (const int words : {1, 2, 3, 4, 6, 8, 16, 32, 64, 100, 200}) {
            if (quick && words > 4) break;
            std::vector<std::function<void()>> passes{op.by_errbound(words), op.by_boost(words)};
            if (op.by_gmp) passes.push_back(op.by_gmp(words));
            const auto t = bench::race(passes, quick ? 1 : 11);
            constexpr std::size_t count = numbers<errbound::integer>::count;
            bench::row& r = all.emplace_back(bench::row{{"operation", op.name},
                                                        {"words", words},
                                                        {"errbound", t[0].ns(count)},
                                                        {"median", t[0].median_ns(count)}});
            constexpr const char* others[] = {"cpp_int", "GMP"};
            for (std::size_t i = 1; i < t.size(); ++i) {
                const std::string name = others[i - 1];
                r[name + "/errbound"] = t[i].minimum / t[0].minimum;
                r[name + "_medians"] = t[i].median / t[0].median;
            }
        }
    }
    out.table("integers", {}, "operations on integers, ns (least and median of some passes)", all);
}

}  // namespace

int main(int argc, char** argv) {
    bench::program bench("./run bench --integers", "Integers next to Boost's and GMP's.");
    return bench.run(argc, argv, [&](bench::report& out) { run(bench.quick, out); });
}
