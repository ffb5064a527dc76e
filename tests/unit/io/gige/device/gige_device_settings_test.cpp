// What the camera's own registers do.

#include <gmock/gmock.h>

#include <cmath>

#include "gige_bench.h"
#include "io/gige/device/gige_features.h"

namespace hilcam {
namespace {

namespace reg = feature_register;

TEST(GigeSettings, GeometryStaysOnTheSensorAndIsLockedWhileStreaming) {
    GigeBench b;
    b.take_control();
    EXPECT_EQ(b.write(reg::kOffsetX, 1), gvcp::kInvalidParameter);  // full width leaves no room
    EXPECT_EQ(b.write(reg::kWidth, 320), gvcp::kSuccess);
    EXPECT_EQ(b.read(reg::kOffsetXMax), 320u);
    EXPECT_EQ(b.write(reg::kOffsetX, 320), gvcp::kSuccess);
    EXPECT_EQ(b.read(reg::kWidthRoom), 320u);
    EXPECT_EQ(b.write(reg::kWidth, 321), gvcp::kInvalidParameter);
    EXPECT_EQ(b.read(reg::kPayloadSize), 320u * 480 * 2);
    EXPECT_EQ(b.write(reg::kPixelFormat, pfnc_code(WireFormat::kMono8, {})), gvcp::kSuccess);
    EXPECT_EQ(b.read(reg::kPayloadSize), 320u * 480);
    EXPECT_EQ(b.write(reg::kPixelFormat, pfnc_code(WireFormat::kBayer8, "RGGB")), gvcp::kInvalidParameter);
    b.write(reg::kAcquisitionStart, 1);
    EXPECT_EQ(b.read(reg::kParamsLocked), 1u);
    for (const std::uint32_t address : {reg::kWidth, reg::kOffsetY, reg::kPixelFormat, reg::kBinningX,
                                        reg::kChunkMode, reg::kUserSetLoad, reg::kAcquisitionMode})
        EXPECT_EQ(b.write(address, 1), gvcp::kWriteProtect) << std::hex << address;
    b.write(reg::kAcquisitionStop, 1);
    EXPECT_EQ(b.write(reg::kWidth, 100), gvcp::kSuccess);
    b.write(reg::kParamsLocked, 1);  // as transport layers of hosts do
    EXPECT_EQ(b.write(reg::kWidth, 101), gvcp::kWriteProtect);
    b.write(reg::kParamsLocked, 0);
    EXPECT_EQ(b.write(reg::kWidth, 101), gvcp::kSuccess);
}

TEST(GigeSettings, AMosaicsWindowMovesInWholeCells) {
    CameraLimits colour = PlainCamera().l;
    colour.color_pattern = "RGGB";
    GigeBench b(&colour);
    b.take_control();
    EXPECT_EQ(b.write(reg::kWidth, 321), gvcp::kInvalidParameter);
    EXPECT_EQ(b.write(reg::kWidth, 322), gvcp::kSuccess);
    EXPECT_EQ(b.write(reg::kOffsetX, 1), gvcp::kInvalidParameter);
    EXPECT_EQ(b.write(reg::kOffsetX, 2), gvcp::kSuccess);
    EXPECT_EQ(b.read(reg::kPixelFormat), pfnc_code(WireFormat::kBayer12, "RGGB"));
    EXPECT_EQ(b.write(reg::kPixelFormat, pfnc_code(WireFormat::kMono8, {})), gvcp::kInvalidParameter);
}

TEST(GigeSettings, BinningMakesTheWindowFit) {
    GigeBench b;
    b.take_control();
    EXPECT_EQ(b.write(reg::kBinningX, 3), gvcp::kInvalidParameter);
    EXPECT_EQ(b.write(reg::kBinningX, 2), gvcp::kSuccess);
    EXPECT_EQ(b.camera.s.binning_x, 2);
    EXPECT_EQ(b.read(reg::kWidthMax), 320u);
    EXPECT_EQ(b.read(reg::kWidth), 320u);  // a whole picture stays whole
    EXPECT_EQ(b.device.stream_state().binning_x, 2u);
    b.camera.s.binning_x = 1;  // someone else's command
    b.wait_ms(50);
    EXPECT_EQ(b.read(reg::kWidth), 640u);
    b.write(reg::kAcquisitionStart, 1);
    b.camera.s.binning_x = 4;
    b.wait_ms(50);
    EXPECT_EQ(b.read(reg::kWidth), 640u);  // locked
    b.write(reg::kAcquisitionStop, 1);
    EXPECT_EQ(b.read(reg::kWidth), 160u);
}

TEST(GigeSettings, FloatsGoToTheCameraAndAreRefusedOutsideItsLimits) {
    GigeBench b;
    b.take_control();
    EXPECT_EQ(b.write_real(reg::kExposureTime_us, 2500), gvcp::kSuccess);
    EXPECT_DOUBLE_EQ(b.camera.s.exposure_s, 0.0025);
    EXPECT_EQ(b.write_real(reg::kExposureTime_us, 1e9), gvcp::kInvalidParameter);
    EXPECT_EQ(b.write_real(reg::kGain_db, std::nan("")), gvcp::kInvalidParameter);
    EXPECT_EQ(b.write_real(reg::kBlackLevel_dn, 64), gvcp::kSuccess);
    EXPECT_EQ(b.camera.s.black_level_dn, 64);
    b.camera.s.gain_db = 7;  // what another party changed is read back
    EXPECT_EQ(b.read_real(reg::kGain_db), 7);
    EXPECT_EQ(b.write(reg::kGain_db, 0), gvcp::kInvalidParameter);  // half a number
    EXPECT_EQ(b.write(reg::kExposureAuto, 1), gvcp::kSuccess);
    EXPECT_TRUE(b.camera.s.automatic_exposure);
    EXPECT_EQ(b.write(reg::kTestPattern, 2), gvcp::kSuccess);
    EXPECT_EQ(b.camera.s.test_pattern, TestPattern::kWhite);
    EXPECT_EQ(b.write(reg::kTestPattern, 6), gvcp::kInvalidParameter);
    EXPECT_EQ(b.write(reg::kReverseX, 1), gvcp::kSuccess);
    EXPECT_TRUE(b.camera.s.reverse_x);
}

TEST(GigeSettings, WithoutItsOwnFrameRateTheCameraRunsAtItsHighest) {
    GigeBench b;
    b.take_control();
    EXPECT_EQ(b.write(reg::kFrameRateEnable, 0), gvcp::kSuccess);
    EXPECT_EQ(b.read_real(reg::kFrameRate_hz), 200);
    EXPECT_EQ(b.write_real(reg::kFrameRate_hz, 10), gvcp::kWriteProtect);
    EXPECT_EQ(b.write(reg::kFrameRateEnable, 1), gvcp::kSuccess);
    EXPECT_EQ(b.read_real(reg::kFrameRate_hz), 30);
}

TEST(GigeSettings, AcquisitionModesCountTheirFrames) {
    GigeBench b;
    b.take_control();
    const struct { std::uint32_t mode, frames; } cases[] = {{0, 0}, {1, 1}, {2, 7}};
    b.write(reg::kAcquisitionFrameCount, 7);
    for (const auto& c : cases) {
        EXPECT_EQ(b.write(reg::kAcquisitionMode, c.mode), gvcp::kSuccess);
        b.write(reg::kAcquisitionStart, 1);
        EXPECT_EQ(b.device.stream_state().frames, c.frames);
        b.device.acquisition_finished(b.device.stream_state().epoch - 1);  // an older one's end
        EXPECT_TRUE(b.device.stream_state().acquiring);
        b.device.acquisition_finished(b.device.stream_state().epoch);
        EXPECT_FALSE(b.device.stream_state().acquiring);
    }
    EXPECT_EQ(b.write(reg::kAcquisitionMode, 3), gvcp::kInvalidParameter);
}

TEST(GigeSettings, TriggersAreForFramesOrBursts) {
    GigeBench b;
    b.take_control();
    b.write(reg::kBurstFrameCount, 5);
    b.write(reg::kTriggerMode, 1);  // FrameStart
    EXPECT_TRUE(b.camera.s.triggered);
    EXPECT_EQ(b.camera.s.burst_frames, 1);
    b.write(reg::kTriggerSelector, 1);  // FrameBurstStart
    EXPECT_EQ(b.read(reg::kTriggerMode), 0u);
    b.write(reg::kTriggerMode, 0);  // is off already
    EXPECT_TRUE(b.camera.s.triggered);
    b.write(reg::kTriggerMode, 1);
    EXPECT_EQ(b.camera.s.burst_frames, 5);
    b.write(reg::kTriggerSelector, 0);
    EXPECT_EQ(b.read(reg::kTriggerMode), 0u);  // one of the two
    b.write(reg::kTriggerSource, 2);
    EXPECT_EQ(b.camera.s.trigger_source, TriggerSource::kAction1);
    EXPECT_EQ(b.write_real(reg::kTriggerDelay_us, 1500), gvcp::kSuccess);
    EXPECT_DOUBLE_EQ(b.camera.s.trigger_delay_s, 0.0015);
    EXPECT_EQ(b.write(reg::kTriggerSoftware, 1), gvcp::kSuccess);
    ASSERT_EQ(b.camera.triggers.size(), 1u);
    EXPECT_EQ(b.camera.triggers[0].source, TriggerSource::kSoftware);
    b.camera.trigger_result = TriggerResult::kMissed;  // told by an event
    EXPECT_EQ(b.write(reg::kTriggerSoftware, 1), gvcp::kSuccess);
    b.camera.trigger_result = TriggerResult::kNotArmed;
    EXPECT_EQ(b.write(reg::kTriggerSoftware, 1), gvcp::kAccessDenied);
}

// Drivers switch every trigger off before they switch on theirs: AcquisitionStart is among those that Basler's and others' cameras have.
TEST(GigeSettings, AnAcquisitionWaitsForItsTrigger) {
    GigeBench b;
    b.take_control();
    const auto exposure_starts = [&] {
        b.now_ns += 1'000'000;
        b.device.on_event({CameraEvent::Kind::kExposureStart, 1, b.now_ns}, 0, b.now_ns);
    };
    b.write(reg::kTriggerSelector, 2);  // AcquisitionStart
    EXPECT_EQ(b.read(reg::kTriggerMode), 0u);
    EXPECT_EQ(b.write(reg::kTriggerMode, 0), gvcp::kSuccess);
    EXPECT_FALSE(b.camera.s.triggered);
    EXPECT_EQ(b.write(reg::kTriggerMode, 1), gvcp::kSuccess);
    EXPECT_EQ(b.read(reg::kTriggerMode), 1u);
    EXPECT_TRUE(b.camera.s.triggered);
    EXPECT_EQ(b.camera.s.burst_frames, 1);
    b.write(reg::kTriggerSelector, 0);
    EXPECT_EQ(b.read(reg::kTriggerMode), 0u);  // of frames it is off
    // Before the stream has begun no trigger counts.
    EXPECT_EQ(b.write(reg::kTriggerSoftware, 1), gvcp::kAccessDenied);
    for (int acquisition = 0; acquisition < 2; ++acquisition) {
        b.write(reg::kAcquisitionStart, 1);
        EXPECT_TRUE(b.camera.s.triggered);
        EXPECT_EQ(b.write(reg::kTriggerSoftware, 1), gvcp::kSuccess);
        exposure_starts();
        EXPECT_FALSE(b.camera.s.triggered);  // it runs freely from there
        exposure_starts();
        EXPECT_FALSE(b.camera.s.triggered);
        b.write(reg::kAcquisitionStop, 1);
        EXPECT_TRUE(b.camera.s.triggered);  // and waits again
    }
    b.write(reg::kTriggerMode, 1);  // FrameStart takes over
    b.write(reg::kTriggerSelector, 2);
    EXPECT_EQ(b.read(reg::kTriggerMode), 0u);
    EXPECT_TRUE(b.camera.s.triggered);
    b.write(reg::kAcquisitionStart, 1);
    exposure_starts();
    EXPECT_TRUE(b.camera.s.triggered);
    EXPECT_EQ(b.write(reg::kTriggerSelector, 3), gvcp::kInvalidParameter);
}

TEST(GigeSettings, TheTriggerInputHasTheNamesThatClientsHaveForIt) {
    GigeBench b(nullptr, {"Line1", "Line2"});
    b.take_control();
    EXPECT_EQ(b.write(reg::kTriggerSource, 4), gvcp::kSuccess);  // Line2
    EXPECT_EQ(b.camera.s.trigger_source, TriggerSource::kLine0);
    EXPECT_EQ(b.read(reg::kTriggerSource), 4u);
    EXPECT_EQ(b.write(reg::kTriggerSource, 5), gvcp::kInvalidParameter);
    b.write(reg::kTriggerSource, 1);
    EXPECT_EQ(b.read(reg::kTriggerSource), 1u);
    for (const std::uint32_t line : {0u, 1u, 2u}) {
        EXPECT_EQ(b.write(reg::kLineSelector, line), gvcp::kSuccess);
        EXPECT_EQ(b.write(reg::kLineMode, 0), gvcp::kSuccess);  // Input
        EXPECT_EQ(b.write(reg::kLineMode, 1), gvcp::kInvalidParameter);
        EXPECT_EQ(b.read(reg::kLineStatus), 0u);
    }
    EXPECT_EQ(b.write(reg::kLineSelector, 3), gvcp::kInvalidParameter);
    const std::string xml = b.device.xml();
    for (const char* const entry : {"<EnumEntry Name=\"Line1\">", "<EnumEntry Name=\"Line2\">"}) {
        const std::size_t first = xml.find(entry);
        ASSERT_NE(first, std::string::npos) << entry;  // of TriggerSource, then of LineSelector
        EXPECT_NE(xml.find(entry, first + 1), std::string::npos) << entry;
    }
}

TEST(GigeSettings, ExposureIsFoundOnce) {
    GigeBench b;
    b.take_control();
    const auto frame = [&](double exposure_s) {
        b.camera.s.exposure_s = exposure_s;
        b.now_ns += 1'000'000;
        b.device.on_event({CameraEvent::Kind::kExposureStart, 1, b.now_ns}, 0, b.now_ns);
    };
    EXPECT_EQ(b.write(reg::kExposureAuto, 2), gvcp::kSuccess);
    for (const double exposure_s : {0.001, 0.01, 0.05, 0.05, 0.0501, 0.05}) {
        frame(exposure_s);
        EXPECT_EQ(b.read(reg::kExposureAuto), 2u);
        EXPECT_TRUE(b.camera.s.automatic_exposure);
    }
    frame(0.05);
    EXPECT_EQ(b.read(reg::kExposureAuto), 0u);
    EXPECT_FALSE(b.camera.s.automatic_exposure);
    // A scene that does not come to rest does not keep a client waiting, and Continuous goes on.
    b.write(reg::kExposureAuto, 2);
    for (int i = 0; i < 64; ++i) frame(i % 2 ? 0.001 : 0.1);
    EXPECT_EQ(b.read(reg::kExposureAuto), 0u);
    b.write(reg::kExposureAuto, 1);
    for (int i = 0; i < 100; ++i) frame(0.05);
    EXPECT_EQ(b.read(reg::kExposureAuto), 1u);
    EXPECT_EQ(b.write(reg::kExposureAuto, 3), gvcp::kInvalidParameter);
}

// A sequence of settings, or a line scanner, sets exposure, gain and frame rate itself.
TEST(GigeSettings, WhatTheCameraSetsItselfIsReadOnlyAndItsExposureIsNotSearchedFor) {
    CameraLimits own = PlainCamera().l;
    own.exposure_is_own = own.gain_is_own = own.frame_rate_is_own = true;
    own.has_automatic_exposure = false;
    GigeBench b(&own);
    b.take_control();
    EXPECT_EQ(b.write(reg::kExposureAuto, 0), gvcp::kSuccess);
    for (const std::uint32_t mode : {1u, 2u})  // Continuous, Once
        EXPECT_EQ(b.write(reg::kExposureAuto, mode), gvcp::kInvalidParameter);
    EXPECT_FALSE(b.camera.s.automatic_exposure);
    const CameraLimits settable = PlainCamera().l;
    for (const CameraLimits* limits : std::initializer_list<const CameraLimits*>{&own, &settable}) {
        const bool is_own = limits == &own;
        int found = 0;
        for (const Feature& f : gige_features(*limits, false).features) {
            if (f.name == "ExposureTime" || f.name == "Gain" || f.name == "AcquisitionFrameRate") {
                EXPECT_EQ(f.access, is_own ? Feature::Access::kRead : Feature::Access::kReadWrite) << f.name;
                ++found;
            }
            if (f.name == "ExposureAuto") {
                EXPECT_EQ(f.entries.size(), is_own ? 1u : 3u);
            }
        }
        EXPECT_EQ(found, 3);
    }
}

TEST(GigeSettings, TheResultingFrameRateIsWhatExposuresLeave) {
    GigeBench b;
    b.take_control();
    EXPECT_EQ(b.read_real(reg::kResultingFrameRate_hz), 30);
    b.write_real(reg::kExposureTime_us, 900e3);
    EXPECT_NEAR(b.read_real(reg::kResultingFrameRate_hz), 1 / 0.9, 1e-12);
    EXPECT_EQ(b.read_real(reg::kFrameRate_hz), 30);
}

TEST(GigeSettings, ChunksAreChosenOneByOneAndCounted) {
    GigeBench b;
    b.take_control();
    const std::uint32_t image = b.read(reg::kPayloadSize);
    b.write(reg::kChunkMode, 1);
    for (std::uint32_t i = 0; i < kChunks; ++i) {
        b.write(reg::kChunkSelector, i);
        EXPECT_EQ(b.read(reg::kChunkEnable), 1u);
        b.write(reg::kChunkEnable, i == 0 || i == 5);
    }
    EXPECT_EQ(b.device.stream_state().chunks, 1u | 1u << 5);
    EXPECT_EQ(b.read(reg::kPayloadSize), image + 8 + (8 + 8) + (4 + 8));
    EXPECT_EQ(b.write(reg::kChunkSelector, kChunks), gvcp::kInvalidParameter);
}

TEST(GigeSettings, AMultipartStreamMayHaveItsConfidenceToo) {
    GigeBench b;
    b.take_control();
    const std::uint32_t image = b.read(reg::kPayloadSize), pixels = 640 * 480;
    EXPECT_EQ(b.read(reg::kComponentId), 1u);

    EXPECT_EQ(b.write(reg::kComponentSelector, 1), gvcp::kSuccess);
    EXPECT_EQ(b.read(reg::kComponentId), 6u);
    EXPECT_EQ(b.read(reg::kComponentEnable), 0u);
    EXPECT_EQ(b.write(reg::kComponentEnable, 1), gvcp::kSuccess);
    EXPECT_EQ(b.read(reg::kPayloadSize), image);  // of one part
    EXPECT_EQ(b.write(bootstrap::kStreamConfig, bootstrap::stream_config::kMultipart), gvcp::kSuccess);
    EXPECT_EQ(b.read(reg::kPayloadSize), image + pixels);
    b.write(reg::kComponentSelector, 0);
    EXPECT_EQ(b.write(reg::kComponentEnable, 0), gvcp::kSuccess);
    EXPECT_EQ(b.read(reg::kPayloadSize), pixels);
    b.write(reg::kComponentSelector, 1);
    EXPECT_EQ(b.write(reg::kComponentEnable, 0), gvcp::kSuccess);
    EXPECT_EQ(b.read(reg::kPayloadSize), image);  // none: the intensity
    EXPECT_EQ(b.device.stream_state().components, 1u);
}

TEST(GigeSettings, UserSetsKeepAllThatIsSet) {
    GigeBench b;
    b.take_control();
    b.write(reg::kWidth, 128);
    b.write_real(reg::kExposureTime_us, 5000);
    b.write(reg::kBinningY, 2);
    b.write(reg::kUserSetSelector, 1);
    EXPECT_EQ(b.write(reg::kUserSetSave, 1), gvcp::kSuccess);
    b.write(reg::kUserSetSelector, 0);
    EXPECT_EQ(b.write(reg::kUserSetSave, 1), gvcp::kWriteProtect);  // the camera's files are the default
    EXPECT_EQ(b.write(reg::kUserSetLoad, 1), gvcp::kSuccess);
    EXPECT_EQ(b.read(reg::kWidth), 640u);
    EXPECT_DOUBLE_EQ(b.camera.s.exposure_s, 0.001);
    b.write(reg::kUserSetSelector, 1);
    EXPECT_EQ(b.write(reg::kUserSetLoad, 1), gvcp::kSuccess);
    EXPECT_EQ(b.device.stream_state().width, 128u);
    EXPECT_EQ(b.read(reg::kHeight), 240u);
    EXPECT_DOUBLE_EQ(b.camera.s.exposure_s, 0.005);
    b.camera.l.max_exposure_s = 0.0005;  // all or nothing
    b.write(reg::kUserSetSelector, 0);
    EXPECT_EQ(b.write(reg::kUserSetLoad, 1), gvcp::kInvalidParameter);
    EXPECT_EQ(b.read(reg::kWidth), 128u);
}

TEST(GigeSettings, AResetGoesBackToTheDefaultUserSet) {
    GigeBench b;
    b.take_control();
    b.open_stream();
    b.write(reg::kWidth, 128);
    b.write(reg::kUserSetSelector, 2);
    b.write(reg::kUserSetSave, 1);
    b.write(reg::kUserSetDefault, 2);
    b.write(reg::kWidth, 64);
    b.write(bootstrap::kPacketSize, 9000);
    b.write(bootstrap::kGvspConfig, bootstrap::kExtendedIds);
    b.write(reg::kAcquisitionStart, 1);
    EXPECT_EQ(b.write(reg::kDeviceReset, 1), gvcp::kSuccess);  // answered, then done
    EXPECT_EQ(b.resets, 1);
    EXPECT_FALSE(b.device.controlled());
    const GigeStreamState& s = b.device.stream_state();
    EXPECT_FALSE(s.open || s.acquiring || s.extended_ids);
    EXPECT_EQ(s.width, 128u);
    EXPECT_EQ(s.packet_bytes, 1500u);
}

TEST(GigeSettings, StatisticsAreReadable) {
    GigeBench b;
    b.device.set_statistics({1, 2, 3, 4, 5, 6, 7, 8});
    for (std::uint32_t i = 0; i < 8; ++i) EXPECT_EQ(b.read64(reg::kStatistics + 8 * i), i + 1);
}

}  // namespace
}  // namespace hilcam
