#include "io/vizard/vizard_sink.h"

#include <gtest/gtest.h>

#include <thread>

namespace hilcam {
namespace {

using std::chrono::milliseconds;

FrameRecord record_of(std::uint32_t sequence, std::int64_t time_ns) {
    FrameRecord record;
    record.trigger_sequence = sequence;
    record.exposure_mid.ns = time_ns;
    return record;
}

DnImage frame_of(std::uint16_t dn) {
    DnImage frame(4, 3);
    for (std::uint16_t& value : frame.all()) value = dn;
    return frame;
}

TEST(VizardSink, GivesTheFrameThatWasAskedForAndNoOther) {
    VizardSink sink("v", 8, 8);
    sink.publish(frame_of(1), record_of(5, 100));
    sink.expect(5, {100});
    EXPECT_FALSE(sink.wait_for(milliseconds(1)));
    sink.publish(frame_of(2), record_of(5, 101));  // another sender's number five
    sink.publish(frame_of(3), record_of(4, 100));
    EXPECT_FALSE(sink.wait_for(milliseconds(1)));
    sink.publish(frame_of(4), record_of(5, 100));
    sink.publish(frame_of(5), record_of(5, 100));
    ASSERT_TRUE(sink.wait_for(milliseconds(1)));
    EXPECT_EQ(sink.frame().width(), 4);
    EXPECT_EQ(sink.frame().height(), 3);
    EXPECT_EQ(sink.frame().row(2)[3], 4);
    EXPECT_EQ(sink.record().trigger_sequence, 5u);
    EXPECT_EQ(sink.report().frames, 1u);
}

TEST(VizardSink, AForgottenFrameIsNotTakenForTheNext) {
    VizardSink sink("v", 8, 8);
    sink.expect(1, {10});
    sink.publish(frame_of(1), record_of(1, 10));
    sink.forget();
    sink.publish(frame_of(2), record_of(1, 10));
    sink.expect(2, {20});
    EXPECT_FALSE(sink.wait_for(milliseconds(1)));
    sink.publish(frame_of(3), record_of(2, 20));
    ASSERT_TRUE(sink.wait_for(milliseconds(1)));
    EXPECT_EQ(sink.frame().row(0)[0], 3);
}

// Frames of one thread, given up at any moment by the other: what comes is what was asked for last.
TEST(VizardSink, GivingUpAtAnyMomentLosesNothingElse) {
    VizardSink sink("v", 8, 8);
    std::atomic<std::uint32_t> wanted{0};
    std::atomic<bool> stop{false};
    std::thread loop([&] {
        while (!stop) {
            const std::uint32_t w = wanted.load();
            sink.publish(frame_of(static_cast<std::uint16_t>(w)), record_of(w, w));
            std::this_thread::yield();  // both may have one core
        }
    });
    int given = 0;
    for (std::uint32_t i = 1; i <= 6'000; ++i) {
        sink.expect(i, {i});
        wanted = i;
        if (i % 3 == 0) sink.forget();
        if (i % 3 == 1) {
            ASSERT_TRUE(sink.wait_for(std::chrono::seconds(10)));
            ASSERT_EQ(sink.record().trigger_sequence, i);
            ASSERT_EQ(sink.frame().row(1)[1], static_cast<std::uint16_t>(i));
            ++given;
        }
    }
    stop = true;
    loop.join();
    EXPECT_EQ(given, 2000);
}

}  // namespace
}  // namespace hilcam
