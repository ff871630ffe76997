// Allocations that fail: the n-th of a call, for every n until the call succeeds.
//
// This program replaces operator new. Not seen: memory from malloc, which oneTBB takes for itself,
// and with which GMP and MPFR end the program when there is none.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <exception>
#include <new>
#include <string>
#include <utility>

namespace faults {

enum class failing { one, all_from_it_on };

/// The n-th allocation from now on, of any thread, throws std::bad_alloc.
void fail_at(std::uint64_t n, failing which);
/// No allocation fails any more. Returns whether any has failed.
bool stop();
/// Allocations that are not released yet.
std::int64_t live();

/// For the table at the program's end.
void add_row(const std::string& name, std::uint64_t points);

/// use(object) with an object of make(), the n-th allocation of use() failing, n = 1, 2, ... until
/// none fails. Each time it must throw std::bad_alloc or give what it gives without failures; it
/// must do so again with the same object once there is memory; and nothing may be left when result
/// and object are gone.
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
                EXPECT_TRUE(result == expected) << "another result, and no exception";
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
            if (::testing::Test::HasFailure()) return;  // which hold memory themselves
            EXPECT_EQ(live(), before) << "leaked";
            if (!failed) break;
            ++points;
        }
    add_row(name, points);
}

/// The same of a call without an object.
template <class Call>
void try_every_allocation(const std::string& name, const Call& call) {
    try_every_allocation(
        name, [] { return 0; }, [&call](int) { return call(); });
}

}  // namespace faults
