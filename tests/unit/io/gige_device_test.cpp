#include "io/gige_device.h"

#include <gmock/gmock.h>

#include "io/bytes.h"

namespace hilcam {
namespace {

class FakeCamera : public CameraControl {
  public:
    CameraSettings s{.exposure_s = 0.001, .frame_rate_hz = 30};
    CameraSettings settings() const override { return s; }
    CameraLimits limits() const override {
        return {.width = 640,
                .height = 480,
                .bits = 12,
                .color_pattern = {},
                .least_exposure_s = 1e-5,
                .most_exposure_s = 1,
                .least_gain_db = 0,
                .most_gain_db = 24,
                .least_frame_rate_hz = 0.1,
                .most_frame_rate_hz = 200};
    }
    bool change(const SettingsChange& c) override {
        const CameraLimits l = limits();
        if (c.exposure_s && !(*c.exposure_s >= l.least_exposure_s && *c.exposure_s <= l.most_exposure_s))
            return false;
        if (c.gain_db && !(*c.gain_db >= l.least_gain_db && *c.gain_db <= l.most_gain_db)) return false;
        if (c.frame_rate_hz &&
            !(*c.frame_rate_hz >= l.least_frame_rate_hz && *c.frame_rate_hz <= l.most_frame_rate_hz))
            return false;
        s.exposure_s = c.exposure_s.value_or(s.exposure_s);
        s.gain_db = c.gain_db.value_or(s.gain_db);
        s.frame_rate_hz = c.frame_rate_hz.value_or(s.frame_rate_hz);
        return true;
    }
    TriggerResult trigger(const TriggerOrder&) override { return TriggerResult::kTaken; }
};

constexpr Endpoint kClient{0x7F000001, 40000}, kOther{0x7F000001, 40001};

struct Bench {
    FakeCamera camera;
    FaultBoard faults;
    std::vector<gvcp::ResendRequest> resends;
    std::vector<std::size_t> tests;
    GigeDevice device{{"cam", "S1", "", 0x7F000001, 0xFF000000, 0, 0x020000000001, 1500},
                      camera,
                      faults,
                      {.resend = [this](const gvcp::ResendRequest& r, Endpoint) { resends.push_back(r); },
                       .test_packet = [this](const GigeStreamState&, std::size_t n) { tests.push_back(n); }}};
    std::int64_t now_ns = 0;
    std::uint16_t id = 1;

    struct Reply {
        unsigned status = 0xFFFF, command = 0, id = 0;
        std::vector<std::uint8_t> payload;
    };
    Reply send(std::uint16_t command, const std::vector<std::uint8_t>& payload, Endpoint from = kClient,
               std::uint16_t reuse = 0, std::uint8_t flags = 1) {
        std::vector<std::uint8_t> bytes(8 + payload.size()), out(gvcp::kMostDatagramBytes);
        ByteWriter(bytes)
            .u8(0x42)
            .u8(flags)
            .u16(command)
            .u16(payload.size())
            .u16(reuse ? reuse : id++)
            .copy(payload);
        const std::size_t size = device.handle(bytes, from, now_ns, out);
        if (size == 0) return {};
        ByteReader in(std::span<const std::uint8_t>(out.data(), size));
        Reply r;
        r.status = in.u16();
        r.command = in.u16();
        in.u16();
        r.id = in.u16();
        r.payload.assign(in.rest().begin(), in.rest().end());
        return r;
    }
    static std::vector<std::uint8_t> words(std::initializer_list<std::uint32_t> values) {
        std::vector<std::uint8_t> out(4 * values.size());
        ByteWriter w(out);
        for (const std::uint32_t v : values) w.u32(v);
        return out;
    }
    unsigned write(std::uint32_t address, std::uint32_t value, Endpoint from = kClient) {
        return send(gvcp::kWriteRegister, words({address, value}), from).status;
    }
    std::uint32_t read(std::uint32_t address, Endpoint from = kClient) {
        return ByteReader(send(gvcp::kReadRegister, words({address}), from).payload).u32();
    }
    void take_control() { ASSERT_EQ(write(bootstrap::kControl, 2), gvcp::kSuccess); }
};

TEST(GigeDevice, DiscoveryGivesTheFirst248Registers) {
    Bench b;
    const auto r = b.send(gvcp::kDiscovery, {}, kClient, 0xFFFF);
    EXPECT_EQ(r.status, gvcp::kSuccess);
    EXPECT_EQ(r.command, 0x0003u);
    EXPECT_EQ(r.id, 0xFFFFu);
    ASSERT_EQ(r.payload.size(), 248u);
    EXPECT_STREQ(reinterpret_cast<const char*>(r.payload.data() + 0x48), "hilcam");
    EXPECT_STREQ(reinterpret_cast<const char*>(r.payload.data() + 0xD8), "S1");
}

TEST(GigeDevice, OnlyTheControllerMayWrite) {
    Bench b;
    EXPECT_EQ(b.write(feature_register::kWidth, 100), gvcp::kAccessDenied);  // control first
    b.take_control();
    EXPECT_EQ(b.write(feature_register::kWidth, 100), gvcp::kSuccess);
    EXPECT_EQ(b.write(feature_register::kWidth, 200, kOther), gvcp::kAccessDenied);
    EXPECT_EQ(b.write(bootstrap::kControl, 2, kOther), gvcp::kAccessDenied);
    EXPECT_EQ(b.read(feature_register::kWidth, kOther), 100u);
    EXPECT_EQ(b.write(bootstrap::kControl, 1), gvcp::kSuccess);  // exclusive: others may not even read
    EXPECT_EQ(b.send(gvcp::kReadRegister, Bench::words({0}), kOther).status, gvcp::kAccessDenied);
}

TEST(GigeDevice, ASilentControllerLosesTheCamera) {
    Bench b;
    b.take_control();
    b.write(bootstrap::kStreamAddress, kClient.ip);
    b.write(bootstrap::kStreamPort, 50000);
    b.write(feature_register::kAcquisitionStart, 1);
    b.now_ns = 2'900'000'000;
    b.read(bootstrap::kControl);  // a heartbeat
    b.now_ns = 5'800'000'000;
    b.device.tick(b.now_ns);
    EXPECT_TRUE(b.device.controlled());
    b.now_ns = 5'901'000'000;
    b.device.tick(b.now_ns);
    EXPECT_FALSE(b.device.controlled());
    EXPECT_FALSE(b.device.stream_state().acquiring);
    EXPECT_FALSE(b.device.stream_state().open);
    EXPECT_EQ(b.write(bootstrap::kControl, 2, kOther), gvcp::kSuccess);
}

TEST(GigeDevice, ARepeatedRequestIsAnsweredButNotRunTwice) {
    Bench b;
    b.take_control();
    const auto start = Bench::words({feature_register::kAcquisitionStart, 1});
    b.send(gvcp::kWriteRegister, start, kClient, 700);
    EXPECT_EQ(b.send(gvcp::kWriteRegister, start, kClient, 700).status, gvcp::kSuccess);
    EXPECT_EQ(b.device.stream_state().epoch, 1u);
    b.send(gvcp::kWriteRegister, start, kClient, 701);
    EXPECT_EQ(b.device.stream_state().epoch, 2u);
}

TEST(GigeDevice, ConcatenatedWritesStopAtTheFirstFault) {
    Bench b;
    b.take_control();
    const auto r = b.send(gvcp::kWriteRegister,
                          Bench::words({feature_register::kWidth, 64, feature_register::kSensorWidth, 1,
                                        feature_register::kHeight, 64}));
    EXPECT_EQ(r.status, gvcp::kWriteProtect);
    EXPECT_EQ(ByteReader(std::span(r.payload).subspan(2)).u16(), 1);
    EXPECT_EQ(b.read(feature_register::kWidth), 64u);
    EXPECT_EQ(b.read(feature_register::kHeight), 480u);
}

TEST(GigeDevice, GeometryStaysOnTheSensorAndIsLockedWhileStreaming) {
    Bench b;
    b.take_control();
    EXPECT_EQ(b.write(feature_register::kOffsetX, 1), gvcp::kInvalidParameter);  // full width leaves no room
    EXPECT_EQ(b.write(feature_register::kWidth, 320), gvcp::kSuccess);
    EXPECT_EQ(b.write(feature_register::kOffsetX, 320), gvcp::kSuccess);
    EXPECT_EQ(b.read(feature_register::kPayloadSize), 320u * 480 * 2);
    EXPECT_EQ(b.write(feature_register::kPixelFormat, pfnc_code(WireFormat::kMono8, {})), gvcp::kSuccess);
    EXPECT_EQ(b.read(feature_register::kPayloadSize), 320u * 480);
    EXPECT_EQ(b.write(feature_register::kPixelFormat, 0x02180014), gvcp::kInvalidParameter);
    b.write(feature_register::kAcquisitionStart, 1);
    EXPECT_EQ(b.read(feature_register::kParamsLocked), 1u);
    EXPECT_EQ(b.write(feature_register::kWidth, 100), gvcp::kWriteProtect);
    b.write(feature_register::kAcquisitionStop, 1);
    EXPECT_EQ(b.write(feature_register::kWidth, 100), gvcp::kSuccess);
}

TEST(GigeDevice, FloatsGoToTheCameraAndAreRefusedOutsideItsLimits) {
    Bench b;
    b.take_control();
    std::vector<std::uint8_t> payload(12);
    ByteWriter(payload).u32(feature_register::kExposureTime_us).f64(2500);
    EXPECT_EQ(b.send(gvcp::kWriteMemory, payload).status, gvcp::kSuccess);
    EXPECT_DOUBLE_EQ(b.camera.s.exposure_s, 0.0025);
    ByteWriter(payload).u32(feature_register::kExposureTime_us).f64(1e9);
    EXPECT_EQ(b.send(gvcp::kWriteMemory, payload).status, gvcp::kInvalidParameter);
    ByteWriter(payload).u32(feature_register::kGain_db).f64(std::nan(""));
    EXPECT_EQ(b.send(gvcp::kWriteMemory, payload).status, gvcp::kInvalidParameter);
    // What another party changed is read back.
    b.camera.s.gain_db = 7;
    std::vector<std::uint8_t> ask(8);
    ByteWriter(ask).u32(feature_register::kGain_db).u16(0).u16(8);
    const auto r = b.send(gvcp::kReadMemory, ask);
    EXPECT_EQ(ByteReader(std::span(r.payload).subspan(4)).f64(), 7);
}

TEST(GigeDevice, DescriptionIsReadableInPiecesAndTellsEveryFeature) {
    Bench b;
    std::string url;
    std::vector<std::uint8_t> ask(8);
    ByteWriter(ask).u32(bootstrap::kXmlUrl).u16(0).u16(512);
    const auto r = b.send(gvcp::kReadMemory, ask);
    url = reinterpret_cast<const char*>(r.payload.data() + 4);
    const std::string xml = b.device.xml();
    char expected[64];
    std::snprintf(expected, sizeof expected, "Local:///hilcam.xml;20000;%zX", xml.size());
    EXPECT_EQ(url, expected);
    std::string read;
    for (std::uint32_t at = 0; at < xml.size(); at += 512) {
        ByteWriter(ask).u32(kXmlAddress + at).u16(0).u16(512);
        const auto piece = b.send(gvcp::kReadMemory, ask);
        ASSERT_EQ(piece.status, gvcp::kSuccess);
        read.append(piece.payload.begin() + 4, piece.payload.end());
    }
    EXPECT_EQ(read.substr(0, xml.size()), xml);
    for (const Feature& f : gige_features(b.camera.limits())) {
        EXPECT_THAT(xml, testing::HasSubstr("<pFeature>" + std::string(f.name) + "</pFeature>"));
        // Every register of the description exists.
        ByteWriter(ask).u32(f.address).u16(0).u16(f.bytes);
        EXPECT_EQ(b.send(gvcp::kReadMemory, ask).status, gvcp::kSuccess) << f.name;
    }
}

TEST(GigeDevice, TestPacketAndResendReachTheStream) {
    Bench b;
    b.take_control();
    b.write(bootstrap::kStreamAddress, kClient.ip);
    b.write(bootstrap::kStreamPort, 50000);
    EXPECT_EQ(b.write(bootstrap::kPacketSize, 1u << 31 | 1u << 30 | 9000), gvcp::kSuccess);
    EXPECT_EQ(b.tests, std::vector<std::size_t>{9000 - 28});
    EXPECT_EQ(b.read(bootstrap::kPacketSize), 1u << 30 | 9000u);
    EXPECT_EQ(b.write(bootstrap::kPacketSize, 100), gvcp::kInvalidParameter);
    b.send(gvcp::kPacketResend, Bench::words({7, 3, 5}), Endpoint{kClient.ip, 50000}, 0, 0);
    ASSERT_EQ(b.resends.size(), 1u);
    EXPECT_EQ(b.resends[0].block, 7u);
    EXPECT_EQ(b.resends[0].last_packet, 5u);
    b.send(gvcp::kPacketResend, Bench::words({7, 3, 5}), Endpoint{0x01020304, 50000}, 0, 0);
    EXPECT_EQ(b.resends.size(), 1u);  // not from a stranger
}

TEST(GigeDevice, UnknownCommandsGetAnHonestAnswer) {
    Bench b;
    EXPECT_EQ(b.send(gvcp::kForceIp, std::vector<std::uint8_t>(56)).status, gvcp::kNotImplemented);
    EXPECT_EQ(b.send(0x0100, {}).status, gvcp::kNotImplemented);
    EXPECT_EQ(b.send(gvcp::kReadRegister, Bench::words({2})).status, gvcp::kBadAlignment);
    EXPECT_EQ(b.send(gvcp::kReadRegister, Bench::words({0xFFFFFFF0})).status, gvcp::kInvalidAddress);
    EXPECT_EQ(b.send(gvcp::kReadRegister, {1, 2, 3}).status, gvcp::kInvalidParameter);
}

TEST(GigeDevice, DamagedDatagramsNeverBreakIt) {
    Bench b;
    b.take_control();
    std::uint32_t state = 99;
    const auto next = [&] { return (state = state * 1664525u + 1013904223u) >> 8; };
    const std::uint16_t commands[] = {2, 4, 0x40, 0x80, 0x82, 0x84, 0x86, 0xC0, 0x100};
    std::vector<std::uint8_t> out(gvcp::kMostDatagramBytes);
    for (int i = 0; i < 200000; ++i) {
        std::vector<std::uint8_t> bytes(8 + next() % 560);
        for (std::uint8_t& byte : bytes) byte = next() % 2 ? static_cast<std::uint8_t>(next()) : 0;
        ByteWriter(bytes)
            .u8(0x42)
            .u8(next() & 0xFF)
            .u16(commands[next() % 9])
            .u16(bytes.size() - 8)
            .u16(next() % 65535 + 1);
        if (bytes.size() >= 12 && next() % 2)
            ByteWriter(std::span(bytes).subspan(8)).u32(0xA000 + next() % 0x120 / 4 * 4);
        if (next() % 10 == 0) bytes.resize(next() % bytes.size());
        ASSERT_LE(b.device.handle(bytes, next() % 2 ? kClient : kOther, i * 1000, out), out.size());
        const GigeStreamState& s = b.device.stream_state();
        ASSERT_LE(s.width + s.offset_x, 640u);
        ASSERT_LE(s.height + s.offset_y, 480u);
        ASSERT_GE(s.packet_bytes, 576u);
    }
}

}  // namespace
}  // namespace hilcam
