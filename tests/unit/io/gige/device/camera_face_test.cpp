// A client of a camera with another's face: registers of the vendor's act on hilcam's features, everything else is memory.

#include "io/gige/device/camera_face.h"

#include <gmock/gmock.h>

#include "gige_bench.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

using testing::HasSubstr;
using FieldKind = RegisterField::Kind;
using Of = FaceRow::Of;

constexpr std::uint32_t kWindow = 0x20000, kExposure = 0x20010, kLongest = 0x20014, kFormat = 0x20018,
                        kRun = 0x2001C, kSelector = 0x20020, kTrigger = 0x20024, kReset = 0x20028,
                        kSerial = 0x2002C, kLocked = 0x20030, kGain = 0x20034, kOffset = 0x20038,
                        kChunks = 0x0D24;

FaceRow number(const char* feature, RegisterField field, double scale = 1, Of of = Of::kValue) {
    FaceRow row;
    row.of = of, row.feature = feature, row.field = field;
    row.formula.scale = scale;
    return row;
}
FaceRow choice(const char* feature, RegisterField field, std::vector<FaceValue> values) {
    FaceRow row;
    row.feature = feature, row.field = field, row.values = std::move(values);
    return row;
}
FaceRow command(const char* feature, RegisterField field, std::uint64_t value) {
    FaceRow row;
    row.of = Of::kCommand, row.feature = feature, row.field = field, row.command = value;
    return row;
}

std::shared_ptr<CameraFaceFiles> files() {
    auto f = std::make_shared<CameraFaceFiles>();
    f->xml = "<RegisterDescription></RegisterDescription>";
    FaceTable& t = f->table;
    t.width_px = 640, t.height_px = 480;
    t.rows = {
        number("Width", {.address = kWindow, .low = 16, .high = 31}),
        number("Height", {.address = kWindow, .low = 0, .high = 15}),
        number("ExposureTime", {.address = kExposure, .little_endian = true}, 10),
        number("ExposureTime", {.address = kLongest}, 1000, Of::kMost),
        choice("PixelFormat", {.address = kFormat},
               {{1, "Mono8"}, {2, "Mono12"}, {3, "Mono12"}, {4, "RGBa8"}}),
        command("AcquisitionStart", {.address = kRun}, 1),
        command("AcquisitionStop", {.address = kRun}, 2),
        choice("ChunkModeActive", {.address = kChunks, .low = 31, .high = 31}, {{1, "", 1}, {0, "", 0}}),
        number("TLParamsLocked", {.address = kLocked})};
    FaceRow trigger =
        choice("TriggerMode", {.address = kTrigger, .low = 0, .high = 0}, {{0, "Off"}, {1, "On"}});
    trigger.when = {{{.address = kSelector}, 9}};
    trigger.selector = "TriggerSelector", trigger.selected = "FrameStart";
    t.rows.push_back(trigger);
    t.self_clearing = {{{.address = kReset, .low = 0, .high = 7}, 0x55}};
    t.registers = {{kWindow, 4, false}, {kSerial, 4, true}};
    t.memory = {{kSerial, {1, 2, 3, 4}}, {kSelector, {0, 0, 0, 9}}};
    return f;
}

struct FaceClient : GigeBench {
    explicit FaceClient(std::shared_ptr<const CameraFaceFiles> face = files())
        : GigeBench(nullptr, {}, ClockSource::kTai, false, {}, std::move(face)) {
        take_control();
    }
};

TEST(CameraFace, AFieldsBitsAreHilcamsFeature) {
    FaceClient b;
    EXPECT_EQ(b.read(kWindow), 640u << 16 | 480);
    EXPECT_EQ(b.write(kWindow, 320u << 16 | 100), gvcp::kSuccess);
    EXPECT_EQ(b.device.stream_state().width, 320u);
    EXPECT_EQ(b.device.stream_state().height, 100u);
    EXPECT_EQ(b.read(kWindow), 320u << 16 | 100);
}

TEST(CameraFace, FormulaAndByteOrderAreTheVendors) {
    FaceClient b;
    EXPECT_EQ(b.read(kExposure), 100u << 24);  // 1 ms in steps of 10 us, little-endian
    EXPECT_EQ(b.write(kExposure, 0x2C010000), gvcp::kSuccess);
    EXPECT_DOUBLE_EQ(b.camera.s.exposure_s, 0.003);
    EXPECT_EQ(b.read(kExposure), 0x2C010000u);
    EXPECT_EQ(b.write(kExposure, 0), gvcp::kInvalidParameter);  // shorter than the camera can
    EXPECT_EQ(b.read(kExposure), 0x2C010000u);
    EXPECT_EQ(b.read(kLongest), 1000u);
    EXPECT_EQ(b.write(kLongest, 5), gvcp::kWriteProtect);
}

TEST(CameraFace, AChoiceKeepsTheNumberThatWasWritten) {
    FaceClient b;
    EXPECT_EQ(b.read(kFormat), 2u);  // the first of the two for Mono12
    EXPECT_EQ(b.write(kFormat, 1), gvcp::kSuccess);
    EXPECT_EQ(b.device.stream_state().format, WireFormat::kMono8);
    EXPECT_EQ(b.write(kFormat, 3), gvcp::kSuccess);
    EXPECT_EQ(b.device.stream_state().format, WireFormat::kMono12);
    EXPECT_EQ(b.read(kFormat), 3u);
    EXPECT_EQ(b.write(kFormat, 4), gvcp::kInvalidParameter);  // hilcam has no such format
    EXPECT_EQ(b.write(kFormat, 77), gvcp::kInvalidParameter);
    EXPECT_EQ(b.read(kFormat), 3u);
}

TEST(CameraFace, AChoiceThatTheDescriptionLacksBecomesTheRegisters) {
    const auto f = files();
    f->table.rows[4].values = {{1, "Mono8"}};  // the camera begins with Mono12
    f->table.memory.push_back({kFormat, {0, 0, 0, 1}});
    FaceClient b(f);
    EXPECT_EQ(b.read(kFormat), 1u);
    EXPECT_EQ(b.device.stream_state().format, WireFormat::kMono8);
}

// A list of shutter times beside an exposure in steps: commands do not set the exposure to one of the list.
TEST(CameraFace, AChoiceBesideANumberLeavesTheNumber) {
    const auto f = files();
    f->table.rows.push_back(choice("ExposureTime", {.address = kGain}, {{3, "", 4000}}));
    FaceClient b(f);
    b.open_stream();
    EXPECT_DOUBLE_EQ(b.camera.s.exposure_s, 0.001);
    EXPECT_EQ(b.write(kRun, 1), gvcp::kSuccess);
    EXPECT_DOUBLE_EQ(b.camera.s.exposure_s, 0.001);
    EXPECT_EQ(b.write(kRun, 2), gvcp::kSuccess);
    EXPECT_EQ(b.write(kGain, 3), gvcp::kSuccess);
    EXPECT_DOUBLE_EQ(b.camera.s.exposure_s, 0.004);
    EXPECT_EQ(b.read(kExposure), 0x90010000u);  // 400 steps of 10 us, little-endian
}

TEST(CameraFace, ALimitIsReachedAlthoughItsFormulaIsRounded) {
    const auto f = files();
    FaceRow gain = number("Gain", {.address = kGain, .low = 0, .high = 15});
    gain.formula = {
        .kind = RegisterFormula::Kind::kLogarithm, .scale = 8.68588963807, .offset = -72.2471989595};
    f->table.rows.push_back(gain);
    FaceClient b(f);
    EXPECT_EQ(b.read(kGain), 4096u);
    ASSERT_LT(gain.formula.value(4096), 0);  // dB, below hilcam's least
    EXPECT_EQ(b.write(kGain, 8192), gvcp::kSuccess);
    EXPECT_NEAR(b.camera.s.gain_db, 6.02, 0.01);
    EXPECT_EQ(b.write(kGain, 4096), gvcp::kSuccess);
    EXPECT_EQ(b.camera.s.gain_db, 0);
    EXPECT_EQ(b.write(kGain, 4095), gvcp::kInvalidParameter);
}

TEST(CameraFace, OffsetsThatCountFrom1TakeAravissZero) {
    const auto f = files();
    FaceRow offset = number("OffsetX", {.address = kOffset});
    offset.formula.offset = -1;
    f->table.rows.push_back(offset);
    FaceClient b(f);
    EXPECT_EQ(b.read(kOffset), 1u);
    EXPECT_EQ(b.write(kWindow, 320u << 16 | 100), gvcp::kSuccess);
    EXPECT_EQ(b.write(kOffset, 17), gvcp::kSuccess);
    EXPECT_EQ(b.read(kOffset), 17u);
    EXPECT_EQ(b.write(kOffset, 0), gvcp::kSuccess);
    EXPECT_EQ(b.read(kOffset), 1u);
}

TEST(CameraFace, CommandsRunAndDoNotStay) {
    FaceClient b;
    b.open_stream();
    EXPECT_EQ(b.write(kRun, 1), gvcp::kSuccess);
    EXPECT_TRUE(b.device.stream_state().acquiring);
    EXPECT_EQ(b.read(kRun), 0u);
    EXPECT_EQ(b.write(kWindow, 320u << 16 | 100), gvcp::kWriteProtect);  // locked meanwhile
    EXPECT_EQ(b.write(kRun, 2), gvcp::kSuccess);
    EXPECT_FALSE(b.device.stream_state().acquiring);
    EXPECT_EQ(b.write(kReset, 0x1255), gvcp::kSuccess);
    EXPECT_EQ(b.read(kReset), 0x1200u);
}

TEST(CameraFace, ARowHoldsWhileItsSelectorDoes) {
    FaceClient b;
    EXPECT_EQ(b.write(kTrigger, 1), gvcp::kSuccess);
    EXPECT_TRUE(b.camera.s.triggered);
    EXPECT_EQ(b.write(kSelector, 3), gvcp::kSuccess);
    EXPECT_EQ(b.write(kTrigger, 0), gvcp::kSuccess);  // another trigger's
    EXPECT_TRUE(b.camera.s.triggered);
    EXPECT_EQ(b.write(kSelector, 9), gvcp::kSuccess);
    EXPECT_EQ(b.read(kTrigger), 1u);
}

TEST(CameraFace, EverythingElseIsMemory) {
    FaceClient b;
    EXPECT_EQ(b.read(0xF0F00614), 0u);
    EXPECT_EQ(b.write(0xF0F00614, 0x12345678), gvcp::kSuccess);
    EXPECT_EQ(b.read(0xF0F00614), 0x12345678u);
    EXPECT_EQ(b.write64(0x30000000, 0x0102030405060708), gvcp::kSuccess);
    EXPECT_EQ(b.read64(0x30000000), 0x0102030405060708u);
    EXPECT_EQ(b.write(0xFFFFFFFC, 5), gvcp::kSuccess);
    EXPECT_EQ(b.read(0xFFFFFFFC), 5u);
    EXPECT_EQ(b.write64(0xFFFFFFFC, 5), gvcp::kInvalidAddress);
    EXPECT_EQ(b.read(kSerial), 0x01020304u);
    EXPECT_EQ(b.write(kSerial, 0), gvcp::kWriteProtect);
    EXPECT_EQ(b.write64(kReset, 0), gvcp::kWriteProtect);  // its second half is kSerial
    EXPECT_EQ(b.read(kSerial), 0x01020304u);
    EXPECT_EQ(b.send(gvcp::kReadRegister, b.words({0x30000002})).status, gvcp::kBadAlignment);
    // hilcam's own features are not where they are without a face.
    EXPECT_EQ(b.read(feature_register::kWidth), 0u);
}

TEST(CameraFace, TheStandardsRegistersStayHilcams) {
    FaceClient b;
    EXPECT_EQ(b.read(bootstrap::kStreamChannels), 1u);
    EXPECT_EQ(b.write(bootstrap::kPacketSize, 1400), gvcp::kSuccess);
    EXPECT_EQ(b.device.stream_state().packet_bytes, 1400u);
    EXPECT_EQ(b.write(bootstrap::kPacketSize, 3), gvcp::kInvalidParameter);
    // A vendor's bit in one of them is its own.
    EXPECT_EQ(b.write(kChunks, 1u << 31), gvcp::kSuccess);
    EXPECT_TRUE(b.device.stream_state().chunk_mode);
    EXPECT_EQ(b.read(kChunks), 1u << 31);
    EXPECT_EQ(b.write(kChunks, 1u << 31 | bootstrap::stream_config::kUnconditional), gvcp::kSuccess);
    EXPECT_TRUE(b.device.stream_state().unconditional);
    EXPECT_EQ(b.write(kChunks, 0), gvcp::kSuccess);
    EXPECT_FALSE(b.device.stream_state().chunk_mode);
}

TEST(CameraFace, TheDescriptionIsServedZippedFromAGap) {
    FaceClient b;
    const GigeBench::Reply reply = b.read_memory(bootstrap::kXmlUrl, 512);
    const std::string url(reply.payload.begin() + 4, reply.payload.end());
    unsigned place = 0, bytes = 0;
    ASSERT_EQ(std::sscanf(url.c_str(), "Local:camera.zip;%X;%X", &place, &bytes), 2) << url;
    EXPECT_EQ(b.read(place), 0x504B0304u);
    EXPECT_EQ(b.write(place, 0), gvcp::kWriteProtect);
    EXPECT_GT(bytes, 100u);
}

TEST(CameraFace, AResetBringsBackTheRegisters) {
    FaceClient b;
    b.write(0x30000000, 7);
    b.write(kSelector, 3);
    b.faults.order({.kind = FaultKind::kDeviceReset});
    b.wait_ms(1);
    b.take_control();
    EXPECT_EQ(b.read(0x30000000), 0u);
    EXPECT_EQ(b.read(kSelector), 9u);
}

TEST(CameraFace, RecordedRegistersReplaceTheTables) {
    auto f = files();
    f->recorded = {{kSerial, {9, 9, 9, 9}}, {kWindow, {0, 0, 0, 0}}};
    FaceClient b(f);
    EXPECT_EQ(b.read(kSerial), 0x09090909u);
    EXPECT_EQ(b.read(kWindow), 640u << 16 | 480);  // what hilcam acts on is what it is now
}

TEST(CameraFace, AnotherSizeAndUnknownFeaturesAreRefused) {
    const auto refusal = [](const std::shared_ptr<CameraFaceFiles>& f) -> std::string {
        try {
            FaceClient b(f);
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    };
    auto small = files();
    small->table.width_px = 320;
    EXPECT_THAT(refusal(small), HasSubstr("320 x 480 pixels, this one has 640 x 480"));
    auto unknown = files();
    unknown->table.rows[0].feature = "Colour";
    EXPECT_THAT(refusal(unknown), HasSubstr("'Colour'"));
}

}  // namespace
}  // namespace hilcam
