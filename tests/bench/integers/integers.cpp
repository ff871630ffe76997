// ns per operation of errbound::integer, compared with Boost's cpp_int and, if installed, GMP's
// integers in Boost's wrapper, by the number of words.
#include <boost/multiprecision/cpp_int.hpp>
#include <cstdint>
#include <cstdio>
#include <errbound/integers/integer.hpp>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "ccd/lab/machine.hpp"
#include "tests/bench/harness.hpp"
#ifdef ERRBOUND_HAVE_GMP
#include <boost/multiprecision/gmp.hpp>
#endif

namespace {

namespace mp = boost::multiprecision;
using boost_integer = mp::number<mp::cpp_int_backend<>, mp::et_off>;

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
    /// Stores the operation's result for each pair, in numbers that outlive the call.
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

void run(bool quick) {
    bench::report out;
    std::vector<std::vector<bench::cell>> rows;
    for (const operation& op : all_operations()) {
        for (const int words : {1, 2, 3, 4, 6, 8, 16, 32, 64, 100, 200}) {
            if (quick && words > 4) break;
            std::vector<std::function<void()>> passes{op.by_errbound(words), op.by_boost(words)};
            if (op.by_gmp) passes.push_back(op.by_gmp(words));
            const auto t = bench::race(passes, quick ? 1 : 11);
            const auto nanoseconds = [](double seconds) {
                return bench::number(1e9 * seconds / numbers<errbound::integer>::count, 1);
            };
            std::vector<bench::cell> row{bench::word(op.name),
                                         bench::count(static_cast<std::uint64_t>(words)),
                                         nanoseconds(t[0].minimum), nanoseconds(t[0].median)};
            for (std::size_t other : {1, 2}) {
                if (other < t.size()) {
                    row.push_back(bench::number(t[other].minimum / t[0].minimum, 2));
                    row.push_back(bench::number(t[other].median / t[0].median, 2));
                } else {
                    row.push_back(bench::none());
                    row.push_back(bench::none());
                }
            }
            rows.push_back(row);
        }
    }
    out.table("integers", {}, "operations on integers, ns (least and median of some passes)",
              {{"operation", "operation", true},
               {"words", "words"},
               {"least", "errbound"},
               {"median", "median"},
               {"boost", "cpp_int/errbound"},
               {"boost_median", "medians"},
               {"gmp", "GMP/errbound"},
               {"gmp_median", "medians"}},
              rows);
}

}  // namespace

int main(int argc, char** argv) {
    const bool quick = argc == 2 && std::string_view(argv[1]) == "--quick";
    if (argc > 1 && !quick) {
        std::fprintf(stderr, "usage: ./run bench --integers [--quick]\n");
        return 2;
    }
    std::printf("%s\n", ccd::lab::text_of(ccd::lab::this_machine(), 1).c_str());
    run(quick);
    return 0;
}
