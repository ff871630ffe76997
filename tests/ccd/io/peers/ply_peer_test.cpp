// Each difference from CGAL that is listed: on its example the readers differ, for that
// reason alone.
#include "tests/ccd/io/peers/ply_peer.hpp"

#include <gtest/gtest.h>

namespace {

using namespace ccd::peers;

TEST(PlyPeer, EachListedDifferenceIsNeededForItsExample) {
    for (const difference& d : ply_differences()) {
        EXPECT_EQ(compare_ply(d.example, d.example), d.when) << d.reason;
        for (const difference& other : ply_differences())
            EXPECT_EQ(other.when == d.when && other.holds(d.example), &other == &d)
                << d.reason << "\nand " << other.reason;
    }
}

TEST(PlyPeer, EachRewritingIsNeededForItsExample) {
    for (const rewriting& r : ply_rewritings()) {
        EXPECT_EQ(compare_ply(r.example, r.example), outcome::peer_differs) << r.reason;
        EXPECT_EQ(compare_ply(r.example, r.rewritten(r.example)), outcome::same) << r.reason;
    }
}

}  // namespace
