// ./run bench --worst: the slowest known input of each public function, and the search for it.
#include <pthread.h>

#include <algorithm>
#include <array>
#include <bit>
#include <boost/multiprecision/cpp_int.hpp>
#include <ccd/batch.hpp>
#include <ccd/exact.hpp>
#include <ccd/method.hpp>
#include <ccd/step.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <errbound/multiprecision.hpp>
#include <errbound/polynomial.hpp>
#include <errbound/predicates.hpp>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "errbound/support/hexadecimal.hpp"
#include "errbound/support/output_file.hpp"
#include "tests/bench/harness.hpp"
#include "tests/support/query_families.hpp"

namespace {

using bench::clock, bench::keep, bench::seconds_since;
using query_families::source;
using input = std::vector<double>;

constexpr double infinity = std::numeric_limits<double>::infinity();

// ---- Public functions, each called with a row of numbers ----

struct subject {
    std::string name;
    std::size_t count;  ///< read by `call`; at most those of a query of four points
    std::function<void(const double*)> call;
    int calls = 1;  ///< queries per call: a batch decides the same query many times
};

template <class Query>
Query query_of(const double* x) {
    std::array<double, sizeof(Query) / sizeof(double)> all;
    std::copy_n(x, all.size(), all.begin());
    return std::bit_cast<Query>(all);
}

template <class Query, class Call>
subject of_query(const std::string& function, const Call& call, int calls = 1) {
    return {function + ", " + std::string(name(ccd::kind_of<Query>)),
            sizeof(Query) / sizeof(double),
            [call](const double* x) { keep(call(query_of<Query>(x))); }, calls};
}

template <class Query>
void add_exact(std::vector<subject>& all) {
    all.push_back(of_query<Query>("decide_exact", [](const Query& q) { return decide_exact(q); }));
    all.push_back(
        of_query<Query>("touches_at_start", [](const Query& q) { return touches_at_start(q); }));
    constexpr int copies = 256;
    all.push_back(of_query<Query>(
        "decide_batch",
        [](const Query& q) {
            return ccd::decide_batch(std::vector<Query>(copies, q), {.threads = 1});
        },
        copies));
}

/// A step of one vertex and one face that share no vertex.
ccd::step_result step_of(const ccd::vertex_face<double>& q) {
    const ccd::mesh before{{q.v.t0, q.f0.t0, q.f1.t0, q.f2.t0}, {{1, 2, 3}}};
    const ccd::mesh after{{q.v.t1, q.f0.t1, q.f1.t1, q.f2.t1}, {{1, 2, 3}}};
    return ccd::step(before, after, {.threads = 1});
}

template <class Shape, class F, class Options>
subject of_predicate(std::string name,
                     const errbound::predicate_type<Shape, F, Options>& predicate) {
    const auto call = [predicate](const double* x) {
        [&]<std::size_t... K>(std::index_sequence<K...>) {
            keep(predicate((x + Shape::offset(K))...));
        }
        (std::make_index_sequence<Shape::count>());
    };
    return {std::move(name), Shape::size, call};
}

subject counting(std::size_t degree) {
    const auto call = [degree](const double* x) {
        const errbound::polynomial<double> p(input(x, x + degree + 1));
        keep(errbound::count_roots<boost::multiprecision::cpp_int>(p, -infinity, infinity));
    };
    return {"count_roots, degree " + std::to_string(degree), degree + 1, call};
}

std::vector<subject> all_subjects() {
    using namespace errbound;
    std::vector<subject> all;
    add_exact<ccd::vertex_face<double>>(all);
    add_exact<ccd::edge_edge<double>>(all);
    add_exact<ccd::vertex_edge<double>>(all);
    add_exact<ccd::vertex_vertex<double>>(all);
    const auto tight = [](const auto& q) { return decide(ccd::method::tight, q); };
    all.push_back(of_query<ccd::vertex_face<double>>("decide by tight", tight));
    all.push_back(of_query<ccd::edge_edge<double>>("decide by tight", tight));
    all.push_back(of_query<ccd::vertex_face<double>>("step of one pair", step_of));
    const auto add = [&](const char* name, const auto& predicate) {
        all.push_back(of_predicate(name, predicate));
    };
    add("orient2d", orient2d);
    add("orient3d", orient3d);
    add("incircle", incircle);
    add("insphere", insphere);
    add("power_incircle", power_incircle);
    add("power_insphere", power_insphere);
    add("compare_distances2d", compare_distances2d);
    add("compare_distances3d", compare_distances3d);
    add("segments_intersect3d", segments_intersect3d);
    add("segment_intersects_triangle", segment_intersects_triangle);
    add("orient2d_line_line", orient2d_line_line);
    add("orient3d_line_plane", orient3d_line_plane);
    add("compare_x_line_line", compare_x_line_line);
    for (const std::size_t degree : {3, 8, 20}) all.push_back(counting(degree));
    return all;
}

// ---- The search ----

struct range {
    const char* name;
    double low, high;  ///< of magnitudes; zeros are allowed, too
};
constexpr range ranges[] = {{"1e-3 to 1e3", 1e-3, 1e3},
                            {"2^-100 to 2^100", 0x1p-100, 0x1p100},
                            {"all finite", 0, 0x1.fffffffffffffp1023}};

bool holds(const range& within, const input& all) {
    return std::ranges::all_of(all, [&](double x) {
        return x == 0 || (within.low <= std::abs(x) && std::abs(x) <= within.high);
    });
}

int drawn_family(source& random) {
    return random.between(0, static_cast<int>(std::size(query_families::families)) - 1);
}

/// The first numbers of a random query of the family.
input drawn(source& random, int which_family, std::size_t count) {
    const auto& family = query_families::families[which_family];
    const auto kind = random.one_in(2) ? ccd::kind::vertex_face : ccd::kind::edge_edge;
    const auto all = std::bit_cast<std::array<double, 24>>(family.make(random, kind));
    return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)};
}

void change(input& x, source& random) {
    const int last = static_cast<int>(x.size()) - 1;
    double& one = x[static_cast<std::size_t>(random.between(0, last))];
    const double other = x[static_cast<std::size_t>(random.between(0, last))];
    switch (random.between(0, 7)) {
        case 0:
            one = std::nextafter(one, infinity);
            break;
        case 1:
            one = std::nextafter(one, -infinity);
            break;
        case 2:
            one = other;
            break;
        case 3:
            one = -one;
            break;
        case 4:
            one = random.between(-3, 3);
            break;
        case 5:
            one = std::ldexp(one, random.between(-60, 60));
            break;
        case 6:
            one = std::ldexp(one, random.between(-1000, 1000));
            break;
        case 7:
            one += std::ldexp(one, -random.between(1, 53));
            break;
    }
}

/// The least seconds of several calls. Disturbances only add to the time.
double seconds_of(const subject& of, const input& x, int times) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < times; ++i) {
        const auto start = clock::now();
        of.call(x.data());
        least = std::min(least, seconds_since(start));
    }
    return least / of.calls;
}

/// The slowest input that hill climbing finds. It starts from `known` inputs (for other functions,
/// their first numbers). For `seconds` it tries queries of every family of
/// tests/support/query_families.hpp and small changes of the slowest input so far.
input slowest(const subject& of, const range& within, const std::vector<input>& known,
              double seconds, std::uint64_t seed) {
    double longest = 0;
    input found;
    const auto look_at = [&](input next) {
        if (!holds(within, next) || seconds_of(of, next, 2) <= longest) return false;
        const double surely = seconds_of(of, next, 7);
        if (surely <= longest) return false;
        longest = surely;
        found = std::move(next);
        return true;
    };
    for (const input& x : known)
        if (x.size() >= of.count) look_at({x.data(), x.data() + of.count});
    source random(seed);
    int slow_family = drawn_family(random);
    const auto begun = clock::now();
    for (double now = 0; now < seconds; now = seconds_since(begun)) {
        if (found.empty() || now < seconds / 2) {
            const int family = random.one_in(2) ? drawn_family(random) : slow_family;
            if (look_at(drawn(random, family, of.count))) slow_family = family;
            continue;
        }
        input next = found;
        for (int changes = random.between(1, 3); changes > 0; --changes) change(next, random);
        look_at(std::move(next));
    }
    return found;
}

// ---- The stack ----

constexpr std::size_t stack_size = std::size_t(4) << 20;

void* call(void* work) {
    (*static_cast<const std::function<void()>*>(work))();
    return nullptr;
}

/// The bytes of the stack whose initial value has changed.
std::size_t used_by(std::function<void()> work) {
    constexpr unsigned char paint = 0xA5;
    const std::unique_ptr<void, void (*)(void*)> memory(std::aligned_alloc(4096, stack_size),
                                                        std::free);
    auto* const lowest = static_cast<unsigned char*>(memory.get());
    if (lowest == nullptr) throw std::runtime_error("no memory for a stack");
    std::fill_n(lowest, stack_size, paint);
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstack(&attributes, lowest, stack_size);
    pthread_t thread;
    const bool failed = pthread_create(&thread, &attributes, call, &work) != 0;
    pthread_attr_destroy(&attributes);
    if (failed) throw std::runtime_error("cannot create a thread to measure a stack");
    pthread_join(thread, nullptr);
    return stack_size -
           static_cast<std::size_t>(
               std::find_if(lowest, lowest + stack_size, [](auto byte) { return byte != paint; }) -
               lowest);
}

/// The bytes of stack that `work` needs in a separate thread, beyond those of an idle thread.
std::size_t stack_of(const std::function<void()>& work) {
    const std::size_t nothing = used_by([] {});
    return std::max(used_by(work), nothing) - nothing;
}

// ---- Stored inputs ----

/// The inputs, by the names of a function and a range.
using inputs = std::map<std::pair<std::string, std::string>, input>;

/// Lines "function; range; number number ...", hexadecimal.
inputs read(const std::filesystem::path& path) {
    inputs all;
    std::istringstream text(errbound::support::read_whole(path));
    for (std::string function, within, numbers, number; std::getline(text, function, ';') &&
                                                        std::getline(text, within, ';') &&
                                                        std::getline(text, numbers);) {
        auto& row = all[{function, within}];
        for (std::istringstream in(numbers); in >> number;)
            row.push_back(std::strtod(number.c_str(), nullptr));
    }
    return all;
}

std::string written(const inputs& all) {
    std::string text;
    for (const auto& [key, numbers] : all) {
        text += key.first + ";" + key.second + ";";
        for (const double x : numbers) text += errbound::support::hexadecimal(x) + ' ';
        text.back() = '\n';
    }
    return text;
}

/// A row for each function and range, of its stored input.
bench::rows timed(const std::vector<subject>& subjects, const inputs& all, int times) {
    bench::rows table;
    for (const subject& s : subjects)
        for (const range& within : ranges) {
            const auto found = all.find({s.name, within.name});
            if (found == all.end() || found->second.size() != s.count)
                throw std::runtime_error("no input is stored for " + s.name + ", " + within.name +
                                         ": --search finds one");
            const input& x = found->second;
            const std::size_t stack = stack_of([&] { s.call(x.data()); });
            table.push_back({{"function", s.name},
                             {"coordinates", within.name},
                             {"us", 1e6 * seconds_of(s, x, times)},
                             {"stack_KiB", static_cast<double>(stack) / 1024}});
        }
    return table;
}

}  // namespace

int main(int argc, char** argv) {
    bench::program bench("./run bench --worst",
                         "The slowest known input of each public function: its time and stack.");
    double search = 0;
    std::uint64_t seed = 1;
    std::string only;
    std::filesystem::path path = WORST_CASES;
    bench.line
        .add_option("--search", search,
                    "Search that many seconds for a slower input of each function and range first, "
                    "and keep it")
        ->check(CLI::PositiveNumber);
    bench.line.add_option("--seed", seed, "Of the search");
    bench.line.add_option("--function", only, "Only functions whose name holds this");
    bench.line.add_option("--inputs", path, "The file of inputs");
    return bench.run(argc, argv, [&](bench::report& out) {
        std::vector<subject> subjects = all_subjects();
        std::erase_if(subjects, [&](const subject& s) { return s.name.find(only) == s.name.npos; });

        inputs all;
        if (std::filesystem::exists(path)) all = read(path);
        for (const subject& s : subjects)
            for (const range& within : ranges) {
                if (search == 0) break;
                std::vector<input> known;
                for (const auto& [key, numbers] : all) known.push_back(numbers);
                all[{s.name, within.name}] = slowest(s, within, known, search, seed);
                errbound::support::write_whole(path, written(all));
            }
        out.table("worst", {}, "the slowest known input of each function",
                  timed(subjects, all, bench.quick ? 1 : 9));
    });
}
