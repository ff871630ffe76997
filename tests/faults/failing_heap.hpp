// Failing allocations: the n-th allocation of a call fails, for every n until the call succeeds.
//
// This program replaces operator new. It does not replace malloc, which oneTBB, GMP and MPFR use;
// the latter two end the program if malloc fails.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <exception>
#include <new>
#include <string>

namespace faults {

enum class failing { one, all_from_it_on };

/// The n-th allocation from now on, in any thread, throws std::bad_alloc.
void fail_at(std::uint64_t n, failing which);
/// Ends the failures. Returns true if an allocation has failed.
bool stop();
/// The number of allocations that are not released yet.
std::int64_t live();

/// Adds a row to the table that is printed at the program's end.
void add_row(const std::string& name, std::uint64_t points);

/// Calls use(object) with an object of make(), with the n-th allocation of use() failing, for n =
/// 1, 2, ... until none fails. Each call must throw std::bad_alloc or return the result of a call
/// without failures. A second call with the same object and enough memory must return that result,
/// too. No memory may be left when result and object are gone.
template <class Make, class Use>
void try_every_allocation(const std::string& name, const Make& make, const Use& use) {
    const auto expected = [&] {
        auto object = make();
        return use(object);
    }();
    const auto fails_at = [&](std::uint64_t n, failing which) {
        auto object = make();
        bool failed = false;
        const auto once = [&] {
            try {
                fail_at(n, which);
                auto result = use(object);
                failed = stop();
                EXPECT_TRUE(result == expected) << "a different result without an exception";
            } catch (const std::bad_alloc&) {
                failed = stop();
            } catch (const std::exception& error) {
                failed = stop();
                ADD_FAILURE() << "threw " << error.what();
            }
        };
        once();
        EXPECT_NO_THROW(EXPECT_TRUE(use(object) == expected)) << "the object is not usable";
        return failed;
    };
    std::uint64_t points = 0;
    for (const failing which : {failing::one, failing::all_from_it_on})
        for (std::uint64_t n = 1;; ++n) {
            SCOPED_TRACE(name + ", allocation " + std::to_string(n));
            const std::int64_t before = live();
            const bool failed = fails_at(n, which);
            if (::testing::Test::HasFailure()) return;  // its failures hold memory
            EXPECT_EQ(live(), before) << "leaked";
            if (!failed) break;
            ++points;
        }
    add_row(name, points);
}

/// Tests a call without an object.
template <class Call>
void try_every_allocation(const std::string& name, const Call& call) {
    try_every_allocation(
        name, [] { return 0; }, [&call](int) { return call(); });
}

}  // namespace faults
