#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tests/support/plate.h"

namespace hilcam {
namespace {

TEST_F(FrameLoopTest, FaultsStrikeTheFramesTheyAreOrderedFor) {
    LoopRig rig(scenario(), {8, 0, false});
    const auto order = [&](FaultKind kind, std::uint64_t frame, double rate = 1, double value = 0) {
        EXPECT_EQ(rig.send(FaultCommand{{kind, rate, value, frame, 1, 0}, false}), CommandStatus::kAccepted);
    };
    order(FaultKind::kImageBlack, 2);
    order(FaultKind::kImageSaturated, 3);
    order(FaultKind::kImageStuck, 5);
    order(FaultKind::kImageTear, 6, 1, 0.5);
    order(FaultKind::kImageBitFlips, 7, 0.01);
    rig.loop.start();
    ASSERT_TRUE(rig.collector.wait_for(8));
    rig.loop.stop();
    LoopRig whole(scenario(), {8, 0, false});
    // The same instants, so that the pictures compare: nothing moves, and noise is keyed by the frame.
    whole.loop.start();
    ASSERT_TRUE(whole.collector.wait_for(8));
    whole.loop.stop();
    const auto& struck = rig.collector.frames;
    const auto& right = whole.collector.frames;
    for (const std::size_t i : {0u, 3u, 7u}) {
        EXPECT_EQ(struck[i].dn, right[i].dn) << i;
        EXPECT_EQ(struck[i].record.faults, 0u) << i;
    }
    EXPECT_EQ(std::accumulate(struck[1].dn.begin(), struck[1].dn.end(), 0u), 0u);
    EXPECT_EQ(struck[1].record.faults, bit_of(FaultKind::kImageBlack));
    EXPECT_TRUE(std::all_of(struck[2].dn.begin(), struck[2].dn.end(), [](auto dn) { return dn == 4095; }));
    EXPECT_EQ(struck[4].dn, right[3].dn);
    EXPECT_TRUE(std::equal(struck[5].dn.begin(), struck[5].dn.begin() + 32 * 64, right[5].dn.begin()));
    EXPECT_TRUE(
        std::equal(struck[5].dn.begin() + 32 * 64, struck[5].dn.end(), right[3].dn.begin() + 32 * 64));
    int flipped = 0;
    for (std::size_t i = 0; i < 64 * 64; ++i)
        if (const unsigned bits = struck[6].dn[i] ^ right[6].dn[i]; bits != 0) {
            EXPECT_EQ(bits & (bits - 1), 0u);  // one bit
            ++flipped;
        }
    // Binomial, 4096 pixels at 1 %: 41 with a standard deviation of 6.4; five of them.
    EXPECT_NEAR(flipped, 41, 32);
    EXPECT_EQ(rig.faults.strikes_of(FaultKind::kImageBitFlips), static_cast<std::uint64_t>(flipped));
    EXPECT_EQ(rig.send(FaultCommand{{FaultKind::kImageTear, 1, 2, 0, 0, 0}, false}),
              CommandStatus::kBadArgument);
}

}  // namespace
}  // namespace hilcam
