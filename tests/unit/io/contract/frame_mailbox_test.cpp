// When lockstep waits for an output: while a frame that somebody takes would be lost, and never otherwise.

#include "io/contract/frame_mailbox.h"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <thread>

#include "io/contract/fault.h"
#include "io/files/sink_files.h"
#include "io/gige/sink_gige.h"
#include "io/uvc/sink_uvc.h"
#include "io/v4l2/sink_v4l2.h"
#include "render/vocabulary/check.h"
#include "tests/support/files.h"
#include "tests/support/quiet_camera.h"

namespace hilcam {
namespace {

constexpr int kWidth = 64, kHeight = 48;

struct Published {
    DnImage image{kWidth, kHeight};
    FrameRecord record;
    Published() { record.bits = 12; }
};

TEST(FrameMailbox, HasRoomTellsWhatPutDoes) {
    FrameMailbox mailbox(kWidth, kHeight, 3);
    Published p;
    mailbox.open();
    for (int i = 0; i < 3; ++i) {
        EXPECT_TRUE(mailbox.has_room());
        mailbox.put(p.image, p.record);
    }
    EXPECT_EQ(mailbox.dropped(), 0u);
    EXPECT_FALSE(mailbox.has_room());
    mailbox.put(p.image, p.record);
    EXPECT_EQ(mailbox.dropped(), 1u);
    ASSERT_TRUE(mailbox.wait());
    EXPECT_FALSE(mailbox.has_room());  // being taken is not taken
    mailbox.done();
    EXPECT_TRUE(mailbox.has_room());
}

TEST(FrameMailbox, WithoutATakerNobodyWaits) {
    FrameMailbox mailbox(kWidth, kHeight, 1);
    Published p;
    mailbox.put(p.image, p.record);
    EXPECT_TRUE(mailbox.has_room());
    mailbox.open();
    EXPECT_FALSE(mailbox.has_room());
    mailbox.close();
    EXPECT_TRUE(mailbox.has_room());
}

using SinkRoom = FilesTest;

TEST_F(SinkRoom, OutputsThatDoNotRunHaveAlwaysRoom) {
    QuietCamera camera;
    FaultBoard faults;
    const SinkContext context{camera, faults};
    GigeConfig gige;
    gige.interface = "127.83.4.1";
    V4l2Config v4l2;
    v4l2.device = "/dev/null";
    std::vector<std::unique_ptr<FrameSink>> sinks;
    sinks.push_back(std::make_unique<GigeSink>(gige, context));
    sinks.push_back(std::make_unique<V4l2Sink>(v4l2, kWidth, kHeight, 10, context));
    sinks.push_back(std::make_unique<UvcSink>(UvcConfig{}, kWidth, kHeight, context));
    sinks.push_back(
        std::make_unique<FilesSink>(FilesConfig{.folder = folder_ / "out"}, kWidth, kHeight, PictureRun{}));
    EXPECT_THROW(sinks[1]->start(), DeviceError);
    Published p;
    for (const auto& sink : sinks) {
        for (int i = 0; i < 20; ++i) {
            EXPECT_TRUE(sink->has_room());
            sink->publish(p.image, p.record);
        }
        sink->stop();
        EXPECT_TRUE(sink->has_room());
    }
}

TEST_F(SinkRoom, WhoWaitsForRoomLosesNoFile) {
    FilesSink sink({.folder = folder_ / "out"}, kWidth, kHeight, PictureRun{});
    sink.start();
    Published p;
    for (p.record.id = 1; p.record.id <= 40; ++p.record.id) {
        while (!sink.has_room()) std::this_thread::sleep_for(std::chrono::microseconds(100));
        sink.publish(p.image, p.record);
    }
    sink.stop();
    EXPECT_EQ(sink.report().frames, 40u);
    EXPECT_EQ(sink.report().dropped, 0u);
}

}  // namespace
}  // namespace hilcam
