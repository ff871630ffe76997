// Each listed difference from the peer: on its example the readers differ, for that reason only.
#include "tests/ccd/io/peers/peer.hpp"

#include <gtest/gtest.h>

namespace {

using namespace ccd::peers;

TEST(Peer, PlainMeshesNeedNoExplanation) {
    const peer& p = the_peer();
    EXPECT_EQ(p.compare(p.plain, p.plain), outcome::same);
    EXPECT_EQ(p.compare("", ""), outcome::same);
}

TEST(Peer, EachListedDifferenceIsNeededForItsExample) {
    const peer& p = the_peer();
    for (const difference& d : p.differences) {
        const std::string text = p.text_of(d.example);
        EXPECT_EQ(p.compare(text, text), d.when) << d.reason;
        for (const difference& other : p.differences)
            EXPECT_EQ(other.when == d.when && other.holds(text), &other == &d)
                << d.reason << "\nand " << other.reason;
    }
}

TEST(Peer, EachRewritingIsNeededForItsExample) {
    const peer& p = the_peer();
    for (const rewriting& r : p.rewritings) {
        const std::string text = p.text_of(r.example);
        EXPECT_EQ(p.compare(text, text), outcome::peer_differs) << r.reason;
        EXPECT_EQ(p.compare(text, r.rewritten(text)), outcome::same) << r.reason;
    }
}

}  // namespace
