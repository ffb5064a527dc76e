// The V4L2 sink's faults, and a device that goes away, on a real v4l2loopback. Runs as root in the guest of
// tools/vm with an idle /dev/video0 of the module; tools/check-devices starts it.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "io/contract/fault.h"
#include "io/v4l2/sink_v4l2.h"
#include "io/v4l2/v4l2_metadata_row.h"
#include "tests/support/quiet_camera.h"

namespace hilcam {
namespace {

constexpr const char* kDevice = "/dev/video0";
constexpr int kWidth = 160, kHeight = 4;

std::string format_of_device() {
    const Fd fd(::open(kDevice, O_RDWR));
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (!fd || v4l2_ioctl(fd.get(), VIDIOC_G_FMT, &format) < 0) return "none";
    return fourcc_text(format.fmt.pix.pixelformat);
}

// Reads with read(), which needs no buffers of its own.
class Reader {
  public:
    Reader() : fd_(::open(kDevice, O_RDWR | O_NONBLOCK)) {}
    // The id in the metadata row of the next frame; 0: none within the time.
    std::uint64_t next_id(std::size_t bytes_per_line, int wait_ms = 1000) {
        std::vector<std::uint8_t> frame(bytes_per_line * (kHeight + 1));
        for (int waited = 0; waited < wait_ms; ++waited) {
            if (::read(fd_.get(), frame.data(), frame.size()) == static_cast<ssize_t>(frame.size())) {
                const auto record = read_metadata_row(std::span(frame).last(bytes_per_line));
                return record ? record->id : 0;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return 0;
    }

    // The newest one's, once no more come. What a module still has from before a restart is not asked about.
    std::uint64_t last_id(std::size_t bytes_per_line) {
        std::uint64_t last = 0;
        for (int silent = 0; silent < 3;) {
            const std::uint64_t id = next_id(bytes_per_line, 100);
            silent = id == 0 ? silent + 1 : 0;
            last = id == 0 ? last : id;
        }
        return last;
    }

  private:
    Fd fd_;
};

struct V4l2Faults : testing::Test {
    QuietCamera camera;
    FaultBoard faults;
    V4l2Config config{
        .format = V4l2Format::kY16, .metadata_row = V4l2Config::MetadataRow::kBottom, .device = kDevice};
    std::unique_ptr<V4l2Sink> sink;
    std::uint64_t id = 0;

    void begin() {
        if (!loaded_loopback_module().loaded) GTEST_SKIP() << "v4l2loopback is not loaded";
        sink = std::make_unique<V4l2Sink>(config, kWidth, kHeight, 50, SinkContext{camera, faults});
        sink->start();
    }
    // One frame, and the time it takes to be delivered.
    void publish(int count = 1) {
        DnImage frame(kWidth, kHeight);
        for (int i = 0; i < count; ++i) {
            FrameRecord record;
            record.id = ++id;
            record.bits = 12;
            eventually([&] { return sink->has_room(); });
            sink->publish(frame, record);
            std::this_thread::sleep_for(std::chrono::milliseconds(30));
        }
    }
    double figure(const std::string& name) {
        for (const auto& [key, value] : sink->report().figures)
            if (key == name) return value;
        return -1;
    }
    // The machine is emulated and slow.
    void eventually(const auto& holds) {
        for (int tries = 0; tries < 500 && !holds(); ++tries)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    std::uint64_t delivered() { return sink->report().frames; }
    void expect_delivered(std::uint64_t frames) {
        eventually([&] { return delivered() >= frames; });
        EXPECT_EQ(delivered(), frames);
    }
};

TEST_F(V4l2Faults, AStallWithholdsFrames) {
    ASSERT_NO_FATAL_FAILURE(begin());
    publish(3);
    expect_delivered(3u);
    faults.order({.kind = FaultKind::kV4l2Stall, .from_frame = 5, .frames = 4});
    publish(8);
    EXPECT_EQ(figure("stalled"), 4);
    expect_delivered(7u);
    Reader reader;
    EXPECT_EQ(reader.last_id(2 * kWidth), 11u);
}

TEST_F(V4l2Faults, ARestartIsSeenByAReaderAsAPauseOnly) {
    ASSERT_NO_FATAL_FAILURE(begin());
    publish(2);
    Reader reader;
    EXPECT_NE(reader.next_id(2 * kWidth), 0u);
    faults.order({.kind = FaultKind::kV4l2Restart});
    publish(5);
    EXPECT_EQ(figure("reopened"), 1);
    expect_delivered(7u);
    EXPECT_EQ(sink->report().fault, "");
    EXPECT_EQ(reader.last_id(2 * kWidth), 7u);
}

TEST_F(V4l2Faults, AFlipOpensWithTheOtherBitDepthAndBack) {
    ASSERT_NO_FATAL_FAILURE(begin());
    publish(2);
    EXPECT_EQ(format_of_device(), "Y16 ");
    faults.order({.kind = FaultKind::kV4l2FormatFlip});
    publish(2);
    EXPECT_EQ(format_of_device(), "GREY");
    Reader reader;
    EXPECT_EQ(reader.last_id(kWidth), 4u);
    reader = Reader{};
    faults.order({.kind = FaultKind::kV4l2FormatFlip});
    publish(2);
    // A reader has it open: old modules keep the format for it, new ones do when it streams.
    const bool held = figure("format_flips_refused") > 0;
    EXPECT_EQ(format_of_device(), held ? "GREY" : "Y16 ");
    expect_delivered(6u);
    EXPECT_EQ(sink->report().fault, "");
}

TEST_F(V4l2Faults, ADeviceThatVanishesIsReportedAndTakenUpAgain) {
    ASSERT_NO_FATAL_FAILURE(begin());
    publish(2);
    struct stat node {};
    ASSERT_EQ(stat(kDevice, &node), 0);
    std::filesystem::remove(kDevice);
    faults.order({.kind = FaultKind::kV4l2Restart});
    publish(4);
    EXPECT_THAT(sink->report().fault, testing::HasSubstr("/dev/video0: cannot be opened"));
    expect_delivered(2u);
    EXPECT_EQ(sink->report().dropped, 4u);
    ASSERT_EQ(mknod(kDevice, S_IFCHR | 0600, node.st_rdev), 0);
    publish(30);  // it tries every half second
    EXPECT_EQ(sink->report().fault, "");
    EXPECT_GT(delivered(), 10u);
}

TEST_F(V4l2Faults, FramesWithoutPausesAreSpacedOut) {
    ASSERT_NO_FATAL_FAILURE(begin());
    DnImage frame(kWidth, kHeight);
    const auto begun = std::chrono::steady_clock::now();
    // As a loop that is not paced does: as fast as the sink takes them.
    for (std::uint64_t taken = 0; taken < 20; taken = delivered()) {
        FrameRecord record;
        record.id = ++id;
        record.bits = 12;
        sink->publish(frame, record);
        std::this_thread::yield();
    }
    // Half a period of 50 frames a second between each: a lower bound, which no load makes shorter.
    EXPECT_GE(std::chrono::steady_clock::now() - begun, std::chrono::milliseconds(190));
    EXPECT_GT(sink->report().dropped, 0u);
}

}  // namespace
}  // namespace hilcam
