#include "render/vocabulary/ahead_thread.h"

#include <gtest/gtest.h>

namespace hilcam {
namespace {

TEST(AheadThread, DoesWhatItIsAskedForOnceEach) {
    int done = 0;
    AheadThread ahead;
    ahead.start([&] { ++done; });
    for (int asked = 1; asked <= 100; ++asked) {
        EXPECT_FALSE(ahead.is_busy());
        ahead.ask();
        ahead.wait();
        EXPECT_EQ(done, asked);
    }
}

TEST(AheadThread, EndsWhenItIsDoneAndIsBusyFromThenOn) {
    int done = 0;
    AheadThread ahead;
    ahead.start([&] { ++done; });
    ahead.ask();
    ahead.stop();
    EXPECT_EQ(done, 1);
    EXPECT_TRUE(ahead.is_busy());
    EXPECT_FALSE(ahead.is_at_work());
    ahead.wait();  // does not wait
    ahead.stop();
}

TEST(AheadThread, NeedsNoStart) {
    AheadThread ahead;
    EXPECT_FALSE(ahead.is_busy());
    ahead.wait();
    ahead.stop();
}

}  // namespace
}  // namespace hilcam
