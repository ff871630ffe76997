#include <pthread.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

#include "ccd/lab/timing.hpp"
#include "tests/bench/worst_cases/worst_cases.hpp"
#include "tests/support/query_families.hpp"

namespace worst_cases {
namespace {

using query_families::source;
using row = std::vector<double>;

bool holds(const range& within, const row& numbers) {
    return std::ranges::all_of(numbers, [&](double x) {
        return x == 0 || (within.low <= std::abs(x) && std::abs(x) <= within.high);
    });
}

int drawn_family(source& random) {
    return random.between(0, static_cast<int>(std::size(query_families::families)) - 1);
}

/// The first numbers of a random query of the family.
row drawn(source& random, int which_family, std::size_t numbers) {
    const auto& family = query_families::families[which_family];
    const auto kind = random.one_in(2) ? ccd::kind::vertex_face : ccd::kind::edge_edge;
    const auto all = std::bit_cast<std::array<double, 24>>(family.make(random, kind));
    return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(numbers)};
}

void change(row& x, source& random) {
    const int last = static_cast<int>(x.size()) - 1;
    double& one = x[static_cast<std::size_t>(random.between(0, last))];
    const double other = x[static_cast<std::size_t>(random.between(0, last))];
    constexpr double infinity = std::numeric_limits<double>::infinity();
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

}  // namespace

double seconds_of(const subject& of, const row& numbers, int times) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < times; ++i) {
        const auto start = ccd::lab::clock::now();
        of.call(numbers.data());
        least = std::min(least, ccd::lab::seconds_since(start));
    }
    return least / of.calls;
}

row slowest(const subject& of, const range& within, const std::vector<row>& known, double seconds,
            std::uint64_t seed) {
    double longest = 0;
    row found;
    const auto look_at = [&](row next) {
        if (!holds(within, next) || seconds_of(of, next, 2) <= longest) return false;
        const double surely = seconds_of(of, next, 7);
        if (surely <= longest) return false;
        longest = surely;
        found = std::move(next);
        return true;
    };
    for (const row& numbers : known)
        if (numbers.size() >= of.numbers) look_at({numbers.data(), numbers.data() + of.numbers});
    source random(seed);
    int slow_family = drawn_family(random);
    const auto begun = ccd::lab::clock::now();
    for (double now = 0; now < seconds; now = ccd::lab::seconds_since(begun)) {
        if (found.empty() || now < seconds / 2) {
            const int family = random.one_in(2) ? drawn_family(random) : slow_family;
            if (look_at(drawn(random, family, of.numbers))) slow_family = family;
            continue;
        }
        row next = found;
        for (int changes = random.between(1, 3); changes > 0; --changes) change(next, random);
        look_at(std::move(next));
    }
    return found;
}

std::size_t stack_of(const std::function<void()>& work) {
    const std::size_t nothing = used_by([] {});
    return std::max(used_by(work), nothing) - nothing;
}

}  // namespace worst_cases
