#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <latch>
#include <limits>
#include <thread>
#include <vector>

#include "tests/support/plate.h"

namespace hilcam {
namespace {

// A run waits for its loop's end while somebody else ends it.
TEST_F(FrameLoopTest, TwoThreadsMayStopItAtOnce) {
    for (int i = 0; i < 8; ++i) {
        LoopRig rig(scenario(", frame_rate_hz: 10"), {}, {"mode=lockstep"});
        rig.loop.start();
        std::latch both(2);
        const auto stop = [&] {
            both.arrive_and_wait();
            rig.loop.stop();
            EXPECT_TRUE(rig.loop.finished());
        };
        std::thread other(stop);
        stop();
        other.join();
    }
}

// A rolling shutter sees two that fly together as it sees two at rest, at a satellite's speed, too: to the
// rounding of single precision, and to numbers that noise rounds the other way.
TEST_F(FrameLoopTest, RowsMoveAgainstWhatIsSeen) {
    const auto file =
        scenario(", frame_rate_hz: 10, shutter: {kind: rolling, line_time_us: 100}", "mode: lockstep\n");
    const auto picture = [&](double speed_m_s) {
        LoopRig rig(file, {1});
        PoseCommand pose;
        pose.motion.time = rig.start;
        pose.motion.velocity_world_m_s = {0, speed_m_s, 0};
        EXPECT_EQ(rig.send(pose), CommandStatus::kAccepted);
        pose.object = 1, pose.motion.pose.position_world_m = {0, 0, 4};
        EXPECT_EQ(rig.send(pose), CommandStatus::kAccepted);
        rig.loop.start();
        EXPECT_EQ(rig.send(ExposeCommand{rig.start + 1'000'000'000, 1}), CommandStatus::kAccepted);
        EXPECT_TRUE(rig.collector.wait_for(1));
        rig.loop.stop();
        return std::move(rig.collector.frames.at(0).dn);
    };
    const std::vector<std::uint16_t> at_rest = picture(0), in_orbit = picture(7600);
    std::size_t different = 0, lit = 0;
    for (std::size_t i = 0; i < at_rest.size(); ++i) {
        if (at_rest[i] > 500) ++lit;
        if (std::abs(at_rest[i] - in_orbit[i]) > 2) ++different;
    }
    EXPECT_GT(lit, 150u);  // 16 x 16 px
    EXPECT_LT(different, 5u);
}

// The picture of an exposure is there when that is over: a run that ends before it has none.
TEST_F(FrameLoopTest, NoFrameIsPublishedBeforeItsExposureIsOver) {
    class Watch : public Collector {
      public:
        std::atomic<std::int64_t> min_late_ns{std::numeric_limits<std::int64_t>::max()};
        void publish(const DnImage& frame, const FrameRecord& record) noexcept override {
            const std::int64_t end_ns = record.exposure_mid_monotonic_ns + 200'000'000;
            min_late_ns = std::min(min_late_ns.load(), monotonic_ns() - end_ns);
            Collector::publish(frame, record);
        }
    };
    for (const std::uint64_t limit : {0u, 2u}) {
        LoopRig rig(scenario(", frame_rate_hz: 2"), {}, {"camera.exposure_ms=400"});
        Watch watch;
        LoopParts parts = rig.parts({limit, 0, true});
        parts.sinks = {&watch};
        FrameLoop loop(parts);
        loop.start();
        if (limit == 0) {
            ASSERT_TRUE(watch.wait_for(1));
            // Within the exposure of the second, which begins 500 ms after the first.
            std::this_thread::sleep_for(std::chrono::milliseconds(300));
        }
        while (limit > 0 && !loop.finished()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        loop.stop();
        EXPECT_EQ(watch.count(), limit == 0 ? 1u : limit);
        EXPECT_EQ(loop.counters().frames.load(), watch.count());
        EXPECT_GE(watch.min_late_ns.load(), -1000) << limit;
    }
}

// By the camera's own rate, too, a frame waits for the outputs that are to lose none, and for no others.
TEST_F(FrameLoopTest, AFreeRunWaitsForOutputsThatAreToLoseNothing) {
    class Slow : public Collector {
      public:
        explicit Slow(bool waited_for) : waited_for_(waited_for) {}
        bool must_be_waited_for() const noexcept override { return waited_for_; }
        bool has_room() const noexcept override { return monotonic_ns() >= room_ns_; }
        void publish(const DnImage& frame, const FrameRecord& record) noexcept override {
            if (!has_room()) ++lost_;
            room_ns_ = monotonic_ns() + (waited_for_ ? 100'000'000 : 1'000'000'000'000);
            Collector::publish(frame, record);
        }
        int lost() const { return lost_; }

      private:
        bool waited_for_;
        std::atomic<std::int64_t> room_ns_{0};
        std::atomic<int> lost_{0};
    };
    LoopRig rig(scenario(", frame_rate_hz: 30"), {});
    Slow files(true), stream(false);
    LoopParts parts = rig.parts({6, 0, true});
    parts.sinks = {&files, &stream};
    FrameLoop loop(parts);
    loop.start();
    ASSERT_TRUE(files.wait_for(6));
    loop.stop();
    EXPECT_EQ(files.lost(), 0);
    EXPECT_EQ(stream.lost(), 5);
    EXPECT_GT(loop.counters().waited_for_outputs_ns.load(), 0);
    EXPECT_GT(loop.counters().deadline_misses.load(), 0u);  // what it costs is told
}

}  // namespace
}  // namespace hilcam
