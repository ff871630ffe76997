// Effects of a host application on its threads and processes, under which calls must work.
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <ccd/batch.hpp>
#include <ccd/contact.hpp>
#include <ccd/exact.hpp>
#include <cstdlib>
#include <errbound/predicates.hpp>
#include <functional>
#include <memory>
#include <vector>

#include "tests/support/query_families.hpp"

namespace {

using query_families::of_all_families;

/// The number of bytes of a thread's stack that `work` uses, with those of the C library: down to
/// the lowest byte written. (Some C libraries do not allow stacks as small as those tested here.)
std::size_t stack_taken_by(std::function<void()> work) {
    constexpr std::size_t size = std::size_t(1) << 20, page = std::size_t(1) << 16;
    constexpr unsigned char untouched = 0xa5;
    const std::unique_ptr<unsigned char, decltype(&std::free)> stack(
        static_cast<unsigned char*>(std::aligned_alloc(page, size)), &std::free);
    std::fill_n(stack.get(), size, untouched);
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    EXPECT_EQ(pthread_attr_setstack(&attributes, stack.get(), size), 0);
    pthread_t thread;
    const auto call = [](void* w) -> void* {
        (*static_cast<std::function<void()>*>(w))();
        return nullptr;
    };
    const bool runs = pthread_create(&thread, &attributes, call, &work) == 0;
    pthread_attr_destroy(&attributes);
    EXPECT_TRUE(runs);
    if (!runs) return 0;
    pthread_join(thread, nullptr);
    const auto* const lowest =
        std::find_if(stack.get(), stack.get() + size, [](auto x) { return x != untouched; });
    return static_cast<std::size_t>(stack.get() + size - lowest);
}

/// A predicate of degree 32: (a − b)^32 − (a − c)^32, by repeated squaring.
constexpr auto of_degree_32 =
    errbound::predicate<errbound::points<1, 1, 1>>([](const auto& a, const auto& b, const auto& c) {
        const auto power = [](const auto& x) {
            const auto square = x * x;
            const auto fourth = square * square;
            const auto eighth = fourth * fourth;
            const auto sixteenth = eighth * eighth;
            return sixteenth * sixteenth;
        };
        return power(a[0] - b[0]) - power(a[0] - c[0]);
    });

// The limits of docs/guarantees.md. Without optimisation each temporary has separate memory.
#ifdef __OPTIMIZE__
constexpr std::size_t most_of_one_query = 64 << 10;
#else
constexpr std::size_t most_of_one_query = 256 << 10;
#endif

TEST(SmallStacks, HoldExactAndEveryPredicate) {
    const auto faces = of_all_families<ccd::vertex_face<double>>(5, 11);
    const auto edges = of_all_families<ccd::edge_edge<double>>(5, 11);
    std::size_t uncertain = 0, signs = 0;
    const std::size_t taken = stack_taken_by([&] {
        for (const auto& q : faces) uncertain += decide_exact(q).outcome == ccd::outcome::uncertain;
        for (const auto& q : edges) uncertain += decide_exact(q).outcome == ccd::outcome::uncertain;
        for (const auto& q : faces) {
            const auto* x = reinterpret_cast<const double*>(&q);
            signs += certain(errbound::power_insphere(x, x + 4, x + 8, x + 12, x + 16));
            signs += certain(errbound::insphere(x, x + 3, x + 6, x + 9, x + 12));
            signs += certain(errbound::orient3d_line_plane(x, x + 3, x + 6, x + 9, x + 12, x + 15,
                                                           x + 18, x + 21));
        }
        // Coordinates 2^2000 apart, equal or different only in the least double, use all words of
        // the last stage.
        constexpr double large = 0x1.1p1000, least = 0x1p-1074;
        EXPECT_EQ(of_degree_32(&large, &least, &least), errbound::sign_type::zero);
        constexpr double other = 3 * least;
        EXPECT_EQ(of_degree_32(&large, &least, &other), errbound::sign_type::positive);
    });
    EXPECT_LE(taken, most_of_one_query);
    EXPECT_EQ(uncertain, 0U);
    EXPECT_EQ(signs, 3 * faces.size());
}

TEST(SmallStacks, HoldBatchesIn320KiB) {
    const auto queries = of_all_families<ccd::edge_edge<double>>(5, 11);
    const auto expected = ccd::decide_batch(queries).answers;
    std::vector<ccd::outcome> answers;
    std::size_t contacts = 0;
    const std::size_t taken = stack_taken_by([&] {
        answers = ccd::decide_batch(queries, {.threads = 1}).answers;
        contacts = ccd::timed_contacts(queries, {.threads = 1}).size();
    });
    EXPECT_LE(taken, 320U << 10);
    EXPECT_EQ(answers, expected);
    EXPECT_GT(contacts, 0U);
}

// The child process does not have the parent's threads and must not wait for them.
TEST(Fork, ChildOfAParentWithThreadsDecides) {
    auto queries = of_all_families<ccd::vertex_face<double>>(20, 11);
    const auto once = queries;
    while (queries.size() < 20000) queries.insert(queries.end(), once.begin(), once.end());
    const auto expected = ccd::decide_batch(queries, {.threads = 2}).answers;
    const pid_t child = fork();
    if (child == 0) {
        alarm(60);
        _exit(ccd::decide_batch(queries, {.threads = 2}).answers == expected ? 0 : 1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status)) << "it never ended, or crashed";
    EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
