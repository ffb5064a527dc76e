// Cameras' reports on their way to one thread, and out of it by UDP.

#include "io/commands/telemetry.h"

#include <gtest/gtest.h>

#include <array>
#include <thread>

#include "tests/support/gvsp_receiver.h"

namespace hilcam {
namespace {

constexpr std::uint32_t kTelemetryHost = 0x7F530701;  // 127.83.7.1
constexpr std::array<std::uint8_t, 2> kCameras = {1, 2};

struct TelemetryOut : testing::Test {
    Fd client = open_udp(kTelemetryHost, 0);
    TelemetryConfig config{.udp_to = {"127.83.7.1:" + std::to_string(endpoint_of(client).port)}};
    std::unique_ptr<TelemetrySender> sender;
    std::vector<std::unique_ptr<FrameSink>> cameras;

    TelemetryOut() {
        config.port.port = 0;
        sender = std::make_unique<TelemetrySender>(config, [] { return HousekeepingFigures{}; });
        for (const auto camera : kCameras) cameras.push_back(sender->sink(camera));
    }
    void publish(FrameSink& camera, std::uint64_t frames) const {
        FrameRecord record;
        for (record.id = 1; record.id <= frames; ++record.id) camera.publish(DnImage(), record);
    }
    // The next one; housekeeping is left out.
    FrameReport receive_report() const {
        while (true) {
            Telemetry telemetry;
            const auto bytes = receive(client, kPatience_ms);
            EXPECT_TRUE(decode_telemetry(bytes, telemetry));
            if (const auto* report = std::get_if<FrameReport>(&telemetry)) return *report;
            if (bytes.empty()) return {};
        }
    }
};

// Two loops at once. Runs under TSan too.
TEST_F(TelemetryOut, EveryCamerasReportsComeInTheirOrder) {
    constexpr std::uint64_t kFrames = 100;  // fewer than a camera's way holds
    sender->start();
    std::thread first([&] { publish(*cameras[0], kFrames); }), second([&] { publish(*cameras[1], kFrames); });
    std::array<std::uint64_t, 3> newest{};
    for (std::uint64_t i = 0; i < 2 * kFrames; ++i) {
        const FrameReport report = receive_report();
        if (report.camera != 1 && report.camera != 2) {
            ADD_FAILURE() << "camera " << int{report.camera} << " after " << i << " reports";
            break;
        }
        EXPECT_EQ(report.frame, ++newest[report.camera]);
    }
    first.join(), second.join();
    sender->stop();
    for (const auto& camera : cameras) {
        EXPECT_EQ(camera->report().frames, kFrames);
        EXPECT_EQ(camera->report().dropped, 0u);
    }
}

TEST_F(TelemetryOut, ACameraThatIsTooFastLosesItsOwnReportsOnly) {
    publish(*cameras[0], 1000);
    publish(*cameras[1], 3);
    sender->start();
    for (std::uint64_t frame = 1; frame <= 3; ++frame)
        for (const auto camera : kCameras) {
            const FrameReport report = receive_report();
            EXPECT_EQ(report.camera, camera);
            EXPECT_EQ(report.frame, frame);
        }
    sender->stop();
    EXPECT_EQ(cameras[0]->report().dropped, 1000u - 256);
    EXPECT_EQ(cameras[1]->report().dropped, 0u);
}

}  // namespace
}  // namespace hilcam
