// The worked examples of docs/protocol.md are what the program sends. They were computed apart from it.

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "io/commands/cfs_codec.h"
#include "tests/support/commands.h"

namespace hilcam {
namespace {

using Bytes = std::vector<std::uint8_t>;

class ProtocolDocument : public testing::Test {
  protected:
    ProtocolDocument() {
        std::ifstream in(std::string(HILCAM_SOURCE_DIR) + "/docs/protocol.md");
        std::stringstream buffer;
        buffer << in.rdbuf();
        text = buffer.str();
    }
    void expect_there(const Bytes& bytes) const {
        EXPECT_THAT(text, testing::HasSubstr("\n    " + hex(bytes) + "\n"));
    }
    std::string text;
};

Bytes encoded(const Acknowledgement& a, const DialectConfig& dialect) {
    Bytes bytes(kMaxPacketBytes);
    bytes.resize(encode_acknowledgement(a, 0, dialect, bytes));
    return bytes;
}
Bytes encoded(const Telemetry& t, std::uint16_t count) {
    Bytes bytes(kMaxPacketBytes);
    bytes.resize(encode_telemetry(t, count, DialectConfig{}, bytes));
    return bytes;
}

TEST_F(ProtocolDocument, Commands) {
    expect_there(encoded(PingCommand{0x1122334455667788}, 5));
    SettingsCommand settings;
    settings.exposure_s = 0.002;
    expect_there(encoded(settings, 6));
    FaultCommand fault;
    fault.order.rate = 0.02;
    fault.order.duration_s = 30;
    expect_there(encoded(fault, 7));
    expect_there(encoded(ExposeCommand{{}, 3}, 8));
    expect_there(encoded(TriggerModeCommand{true, 5}, 9));
    expect_there(encoded(SubscribeCommand{true, true}, 10));
    expect_there(encoded(ClockCommand{ClockCommand::Action::kScale, 1'000'000'000, 0.5, 0}, 11));
    expect_there(encoded(LampCommand{2, {1'500'000'000}, 0.5}, 12));
}

TEST_F(ProtocolDocument, Acknowledgement) {
    expect_there(encoded(hilcam::Acknowledgement{5, CommandStatus::kAccepted, 5, 0x1122334455667788,
                                                 TimeTai{1'000'000'000}, ""},
                         {}));
    hilcam::Acknowledgement clock{kClockFunction, CommandStatus::kAccepted, 11,
                                  1'000'000'000,  TimeTai{2'000'001'000},   ""};
    ClockReading& reading = clock.clock.emplace();
    reading.arrival.ns = 2'000'000'000;
    reading.arrival_monotonic_ns = 10'000'000'000, reading.departure_monotonic_ns = 10'000'002'000;
    reading.scale = 0.5;
    expect_there(encoded(clock, {}));
}

FrameReport some_report() {
    FrameReport r;
    r.camera = 2;
    r.frame = 100;
    r.exposure_mid.ns = 1'500'000'000;
    r.exposure_mid_monotonic_ns = 2'500'000'000;
    r.exposure_s = 0.002;
    r.gain_db = 6;
    r.pose_sequence = 5;
    r.pose_time.ns = 1'000'000'000;
    r.latency_ns = 12'345'678;
    r.faults = 1;
    return r;
}
HousekeepingFigures some_figures() {
    HousekeepingFigures h;
    h.mode = OperatingMode::kTriggered;
    h.running = true;
    h.simulated_time.ns = 10'000'000'000;
    h.monotonic_ns = 20'000'000'000;
    h.uptime_s = 10;
    h.frames = 600;
    h.frame_rate_hz = 60;
    h.deadline_misses = 1;
    h.commands_received = 500, h.commands_refused = 2, h.commands_lost = 3;
    h.latency_p50_s = 0.008, h.latency_p99_s = 0.016;
    h.temperature_c = -20;
    h.active_faults = 1;
    h.clients = 2;
    return h;
}

TEST_F(ProtocolDocument, Telemetry) {
    expect_there(encoded(some_report(), 0));
    expect_there(encoded(some_figures(), 1));
}

constexpr DialectConfig kCfs{Dialect::kCfs};

TEST_F(ProtocolDocument, Cfs) {
    expect_there(hilcam::encoded(PingCommand{0x1122334455667788}, 5, kCfs));
    const TimeTai time{1'767'225'637'500'000'000};  // 2026-01-01T00:00:37.5 TAI
    const Bytes answer =
        encoded(hilcam::Acknowledgement{5, CommandStatus::kAccepted, 5, 0x1122334455667788, time, ""}, kCfs);
    // The document has the two in one block.
    EXPECT_THAT(text, testing::HasSubstr("\n    " + hex(answer)));
    EXPECT_EQ(answer[1] | answer[0] << 8, 0x0901);
}

TEST(TelemetryCodec, ComesBackAsItWentInBothDialects) {
    for (const DialectConfig& dialect : {DialectConfig{}, kCfs}) {
        Bytes bytes(kMaxPacketBytes);
        bytes.resize(encode_telemetry(some_report(), 7, dialect, bytes));
        Telemetry back;
        ASSERT_TRUE(decode_telemetry(bytes, dialect, back));
        const auto& report = std::get<FrameReport>(back);
        EXPECT_EQ(report.camera, 2);
        EXPECT_EQ(report.frame, 100u);
        EXPECT_EQ(report.exposure_mid_monotonic_ns, 2'500'000'000);
        EXPECT_EQ(report.pose_time.ns, 1'000'000'000);
        EXPECT_EQ(report.latency_ns, 12'345'678);
        EXPECT_EQ(report.faults, 1u);
        bytes.assign(kMaxPacketBytes, 0);
        bytes.resize(encode_telemetry(some_figures(), 7, dialect, bytes));
        ASSERT_TRUE(decode_telemetry(bytes, dialect, back));
        const auto& figures = std::get<HousekeepingFigures>(back);
        EXPECT_EQ(figures.mode, OperatingMode::kTriggered);
        EXPECT_EQ(figures.commands_lost, 3u);
        EXPECT_EQ(figures.latency_p99_s, 0.016);
        EXPECT_EQ(figures.clients, 2u);
        bytes.pop_back();
        EXPECT_FALSE(decode_telemetry(bytes, dialect, back));
        EXPECT_FALSE(decode_telemetry(encoded(hilcam::Acknowledgement{}, dialect), dialect, back));
    }
}

TEST(CfsCodec, ChecksumIsRequiredUnlessItIsSaidToBeOptional) {
    constexpr DialectConfig kLax{Dialect::kCfs, ChecksumRule::kOptional};
    Bytes bytes = hilcam::encoded(some_pose(), 16384 + 7, kCfs);
    DecodedCommand d = decode_command(bytes, kCfs);
    ASSERT_EQ(d.status, CommandStatus::kAccepted) << d.reason;
    EXPECT_EQ(d.sequence, 7u);
    EXPECT_EQ(std::get<PoseCommand>(d.command).motion.pose.position_world_m.z, 3.25);
    EXPECT_EQ(cfs_checksum(bytes), 0);
    bytes[7] = 0;
    EXPECT_EQ(decode_command(bytes, kCfs).status, CommandStatus::kBadChecksum);
    EXPECT_EQ(decode_command(bytes, kLax).status, CommandStatus::kAccepted);
    bytes[6] |= 0x80;  // a reserved bit
    EXPECT_EQ(decode_command(bytes, kLax).status, CommandStatus::kAccepted);
    bytes[6] = 99;
    EXPECT_EQ(decode_command(bytes, kLax).status, CommandStatus::kUnknownFunction);
    bytes[6] = 3;
    EXPECT_EQ(decode_command(bytes, kLax).status, CommandStatus::kBadLength);
}

TEST(CfsCodec, StreamsResynchroniseWithAndWithoutChecksums) {
    for (const ChecksumRule rule : {ChecksumRule::kRequired, ChecksumRule::kOptional}) {
        const DialectConfig dialect{Dialect::kCfs, rule};
        PacketStream stream(command_rule(dialect));
        std::vector<std::uint32_t> sequences;
        for (std::uint32_t i = 0; i < 50; ++i) {
            Bytes bytes = {0x19, 0x00, 0xC0, static_cast<std::uint8_t>(i)};
            const Bytes packet = hilcam::encoded(some_pose(), i, dialect);
            bytes.insert(bytes.end(), packet.begin(), packet.end());
            std::copy(bytes.begin(), bytes.end(), stream.room().begin());
            stream.filled(bytes.size());
            for (auto item = stream.next(); item.kind != PacketStream::Item::Kind::kNothing;
                 item = stream.next())
                if (item.kind == PacketStream::Item::Kind::kPacket)
                    sequences.push_back(decode_command(item.bytes, dialect).sequence);
        }
        std::vector<std::uint32_t> expected(50);
        for (std::uint32_t i = 0; i < 50; ++i) expected[i] = i;
        EXPECT_EQ(sequences, expected);
    }
}

}  // namespace
}  // namespace hilcam
