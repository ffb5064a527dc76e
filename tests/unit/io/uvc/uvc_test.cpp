// A USB camera's answers to its host, and the gadget's description. Numbers are those of UVC 1.1 (USB-IF,
// 2005).

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/usb/video.h>

#include <map>

#include "io/contract/fault.h"
#include "io/uvc/sink_uvc.h"
#include "io/uvc/uvc_controls.h"
#include "io/uvc/uvc_gadget.h"
#include "io/uvc/uvc_stream.h"
#include "render/vocabulary/check.h"
#include "tests/support/quiet_camera.h"

namespace hilcam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::int64_t number(const std::optional<UvcAnswer>& answer) {
    EXPECT_TRUE(answer);
    std::int64_t value = 0;
    for (std::size_t i = 0; answer && i < answer->size; ++i)
        value |= std::int64_t{answer->bytes[i]} << (8 * i);
    return value;
}

struct UvcControlsTest : testing::Test {
    QuietCamera camera;
    UvcControls controls{camera};

    std::int64_t get(std::uint8_t unit, std::uint8_t selector, std::uint8_t request) {
        return number(controls.setup(unit, selector, request));
    }
    bool set(std::uint8_t unit, std::uint8_t selector, std::vector<std::uint8_t> bytes) {
        return controls.setup(unit, selector, UVC_SET_CUR) && controls.data(bytes);
    }
    std::int64_t error() { return get(0, UVC_VC_REQUEST_ERROR_CODE_CONTROL, UVC_GET_CUR); }
};

TEST_F(UvcControlsTest, ExposureIsInTenthsOfAMillisecond) {
    const auto selector = UVC_CT_EXPOSURE_TIME_ABSOLUTE_CONTROL;
    EXPECT_EQ(get(kUvcCameraTerminal, selector, UVC_GET_CUR), 100);
    EXPECT_EQ(get(kUvcCameraTerminal, selector, UVC_GET_MIN), 1);  // 10 us is less than the unit
    EXPECT_EQ(get(kUvcCameraTerminal, selector, UVC_GET_MAX), 1000);
    EXPECT_EQ(get(kUvcCameraTerminal, selector, UVC_GET_LEN), 4);
    EXPECT_EQ(get(kUvcCameraTerminal, selector, UVC_GET_INFO), 3);
    EXPECT_TRUE(set(kUvcCameraTerminal, selector, {0x2C, 0x01, 0, 0}));
    EXPECT_DOUBLE_EQ(camera.now.exposure_s, 0.03);
    EXPECT_EQ(get(kUvcCameraTerminal, selector, UVC_GET_CUR), 300);
    EXPECT_EQ(get(kUvcCameraTerminal, selector, UVC_GET_DEF), 100);
    EXPECT_EQ(controls.changes(), 1u);
}

TEST_F(UvcControlsTest, AutomaticExposureIsAperturePriority) {
    EXPECT_EQ(get(kUvcCameraTerminal, UVC_CT_AE_MODE_CONTROL, UVC_GET_CUR), 1);
    EXPECT_EQ(get(kUvcCameraTerminal, UVC_CT_AE_MODE_CONTROL, UVC_GET_RES), 9);
    EXPECT_TRUE(set(kUvcCameraTerminal, UVC_CT_AE_MODE_CONTROL, {8}));
    EXPECT_TRUE(camera.now.automatic_exposure);
    EXPECT_FALSE(set(kUvcCameraTerminal, UVC_CT_AE_MODE_CONTROL, {2}));
    EXPECT_EQ(error(), 4);  // out of range
    EXPECT_TRUE(camera.now.automatic_exposure);
}

TEST_F(UvcControlsTest, GainAndBlackLevel) {
    EXPECT_TRUE(set(kUvcProcessingUnit, UVC_PU_GAIN_CONTROL, {0x7B, 0}));
    EXPECT_DOUBLE_EQ(camera.now.gain_db, 12.3);
    EXPECT_EQ(get(kUvcProcessingUnit, UVC_PU_GAIN_CONTROL, UVC_GET_MAX), 240);
    EXPECT_TRUE(set(kUvcProcessingUnit, UVC_PU_BRIGHTNESS_CONTROL, {0x40, 0}));
    EXPECT_DOUBLE_EQ(camera.now.black_level_dn, 64);
    EXPECT_EQ(get(kUvcProcessingUnit, UVC_PU_BRIGHTNESS_CONTROL, UVC_GET_MAX), 1000);
}

TEST_F(UvcControlsTest, WhatIsNotThereIsRefusedWithAReason) {
    EXPECT_FALSE(controls.setup(7, 1, UVC_GET_CUR));
    EXPECT_EQ(error(), 5);
    EXPECT_FALSE(controls.setup(kUvcCameraTerminal, 0x20, UVC_GET_CUR));
    EXPECT_EQ(error(), 6);
    EXPECT_FALSE(controls.setup(kUvcProcessingUnit, UVC_PU_GAIN_CONTROL, 0x55));
    EXPECT_EQ(error(), 7);
    EXPECT_FALSE(controls.data(std::vector<std::uint8_t>{1, 2}));     // data that nobody announced
    EXPECT_FALSE(set(kUvcProcessingUnit, UVC_PU_GAIN_CONTROL, {1}));  // too short
    camera.accepts = false;
    EXPECT_FALSE(set(kUvcProcessingUnit, UVC_PU_GAIN_CONTROL, {1, 0}));
    EXPECT_EQ(error(), 4);
    EXPECT_EQ(camera.changes, 0);
    EXPECT_EQ(controls.refusals(), 6u);
}

UvcStreamShape shape() {
    UvcStreamShape s;
    s.width = 160;
    s.height = 120;
    s.intervals_100ns = uvc_intervals(12, 30);
    s.preset_100ns = uvc_interval(12);
    return s;
}

TEST(UvcStream, IntervalsAreTheCamerasAndTheUsualOnes) {
    EXPECT_THAT(uvc_intervals(12, 30),
                ElementsAre(333333, 400000, 500000, 666667, 833333, 1000000, 2000000, 10000000));
}

TEST(UvcStream, ProbeAndCommit) {
    UvcStream stream(shape());
    const auto probe = stream.setup(UVC_VS_PROBE_CONTROL, UVC_GET_DEF, 34);
    ASSERT_TRUE(probe);
    EXPECT_EQ(probe->size, 34u);
    EXPECT_EQ(number(UvcAnswer{{probe->bytes[18], probe->bytes[19], probe->bytes[20], probe->bytes[21]}, 4}),
              160 * 120 * 2);
    EXPECT_EQ(stream.setup(UVC_VS_PROBE_CONTROL, UVC_GET_CUR, 26)->size, 26u);  // a UVC 1.0 host
    // 15 frames a second, a tenth of a microsecond off.
    std::vector<std::uint8_t> wanted(34);
    for (std::size_t i = 0; i < 4; ++i) wanted[4 + i] = static_cast<std::uint8_t>(666668u >> (8 * i));
    ASSERT_TRUE(stream.setup(UVC_VS_PROBE_CONTROL, UVC_SET_CUR, 34));
    EXPECT_FALSE(stream.data(wanted));
    ASSERT_TRUE(stream.setup(UVC_VS_COMMIT_CONTROL, UVC_SET_CUR, 34));
    EXPECT_EQ(stream.data(wanted), 666667u);
    EXPECT_FALSE(stream.data(wanted));  // once
    EXPECT_FALSE(stream.setup(9, UVC_GET_CUR, 34));
    EXPECT_FALSE(stream.setup(UVC_VS_PROBE_CONTROL, 0x44, 34));
    ASSERT_TRUE(stream.setup(UVC_VS_COMMIT_CONTROL, UVC_SET_CUR, 34));
    EXPECT_FALSE(stream.data(std::span(wanted).first(7)));
    for (std::size_t i = 0; i < 4; ++i) wanted[4 + i] = 0;  // faster than it can: its fastest
    ASSERT_TRUE(stream.setup(UVC_VS_COMMIT_CONTROL, UVC_SET_CUR, 34));
    EXPECT_EQ(stream.data(wanted), 333333u);
}

TEST(UvcGadget, ItsTreeIsInAnOrderThatConfigfsTakes) {
    UvcConfig config;
    config.command_function = "commands";
    std::vector<std::filesystem::path> made;
    std::map<std::string, std::string> files;
    bool has_commands = false;
    for (const ConfigfsStep& step : uvc_gadget_tree(config, shape())) {
        // A link's target has been made before it, and everything lies in the gadget's own folder.
        if (step.kind == ConfigfsStep::Kind::kLink) {
            EXPECT_THAT(made, testing::Contains(std::filesystem::path(step.content))) << step.path;
        }
        if (step.kind == ConfigfsStep::Kind::kFile) files[step.path.string()] = step.content;
        EXPECT_EQ(*step.path.begin(), "hilcam");
        has_commands |= step.path == "hilcam/configs/c.1/ffs.commands";
        made.push_back(step.path);
    }
    EXPECT_TRUE(has_commands);
    EXPECT_EQ(files["hilcam/idVendor"], "0x1209");
    EXPECT_EQ(files["hilcam/bDeviceClass"], "0xEF");
    const std::string frame = "hilcam/functions/uvc.camera/streaming/uncompressed/yuyv/frame/";
    EXPECT_EQ(files[frame + "wWidth"], "160");
    EXPECT_EQ(files[frame + "dwMaxVideoFrameBufferSize"], "38400");
    EXPECT_EQ(files[frame + "dwDefaultFrameInterval"], "833333");
    EXPECT_THAT(files[frame + "dwFrameInterval"], HasSubstr("333333\n400000\n"));
    EXPECT_EQ(files[frame + "dwMaxBitRate"], "9216009");  // 38400 * 8 / 33.3333 ms
}

TEST(UvcGadget, AMachineWithoutAControllerSaysSo) {
    if (!usb_device_controllers().empty()) GTEST_SKIP() << "this machine has a USB device controller";
    QuietCamera camera;
    FaultBoard faults;
    UvcSink sink({}, 160, 120, {camera, faults});
    try {
        sink.start();
        FAIL();
    } catch (const DeviceError& error) {
        EXPECT_THAT(error.what(), HasSubstr("no USB device controller"));
    }
    EXPECT_THROW(UvcSink({}, 161, 120, {camera, faults}), InputError);
}

}  // namespace
}  // namespace hilcam
