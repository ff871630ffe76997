// Each difference from tinyobjloader that is listed: on its example the readers differ, for that
// reason alone.
#include "tests/ccd/io/peers/obj_peer.hpp"

#include <gtest/gtest.h>

namespace {

using namespace ccd::peers;

TEST(ObjPeer, EachListedDifferenceIsNeededForItsExample) {
    for (const difference& d : obj_differences()) {
        EXPECT_EQ(compare_obj(d.example, d.example), d.when) << d.reason;
        for (const difference& other : obj_differences())
            EXPECT_EQ(other.when == d.when && other.holds(d.example), &other == &d)
                << d.reason << "\nand " << other.reason;
    }
}

TEST(ObjPeer, EachRewritingIsNeededForItsExample) {
    for (const rewriting& r : obj_rewritings()) {
        EXPECT_EQ(compare_obj(r.example, r.example), outcome::peer_differs) << r.reason;
        EXPECT_EQ(compare_obj(r.example, r.rewritten(r.example)), outcome::same) << r.reason;
    }
}

TEST(ObjPeer, PlainMeshesNeedNoExplanation) {
    for (const char* text : {"v 0 0 0\nv 1 0.1 1e-5\nv 0 1 0\nf 1 2 3\nl 1 2 3\n",
                             "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3/1/1 -2//1 -1/1\n",
                             "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", ""})
        EXPECT_EQ(compare_obj(text, text), outcome::same) << text;
}

}  // namespace
