#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "io/commands/command_codec.h"
#include "io/commands/command_sender.h"
#include "io/commands/commands_udp.h"
#include "io/system/bytes.h"
#include "io/system/monotonic.h"
#include "tests/support/commands.h"

namespace hilcam {
namespace {

TEST(Crc16, IsCcittFalse) {
    const std::string text = "123456789";  // the catalogue's check value
    EXPECT_EQ(crc16({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}), 0x29B1);
}

TEST(Acknowledgement, AReasonCommandsNoTerminal) {
    Acknowledgement a;
    a.status = CommandStatus::kBusy;
    EXPECT_EQ(text_of(a), "busy");
    a.reason = "\x1b]0;x\x07\nhilcam: accepted";
    EXPECT_EQ(text_of(a), "busy:  ]0;x  hilcam: accepted");
    a.reason = std::string(60'000, 'x');
    EXPECT_LT(text_of(a).size(), 200u);
}

TEST(CommandCodec, PoseComesBackAsItWent) {
    const DecodedCommand d = decode_command(encoded(some_pose(), 77));
    ASSERT_EQ(d.status, CommandStatus::kAccepted) << d.reason;
    EXPECT_EQ(d.sequence, 77u);
    const auto& p = std::get<PoseCommand>(d.command);
    EXPECT_EQ(p.object, 2);
    EXPECT_EQ(p.motion.time.ns, 123456789);
    EXPECT_EQ(p.motion.pose.position_world_m.z, 3.25);
    EXPECT_EQ(p.motion.pose.world_from_body.y, -0.5);
    EXPECT_EQ(p.motion.rate_body_rad_s.z, 0.01);
}

TEST(CommandCodec, SettingsCarryOnlyWhatWasSet) {
    SettingsCommand s;
    s.gain_db = 3;
    const auto back = std::get<SettingsCommand>(decode_command(encoded(s, 1)).command);
    EXPECT_FALSE(back.exposure_s);
    EXPECT_EQ(back.gain_db, 3);
}

TEST(CommandCodec, JointComesBackAndWildAnglesAreRefused) {
    JointCommand joint{2, 3, {77}, -1.5, 0.25};
    const auto back = std::get<JointCommand>(decode_command(encoded(joint, 4)).command);
    EXPECT_EQ(back.object, 2);
    EXPECT_EQ(back.joint, 3);
    EXPECT_EQ(back.time.ns, 77);
    EXPECT_EQ(back.angle_rad, -1.5);
    EXPECT_EQ(back.rate_rad_s, 0.25);
    joint.angle_rad = 1e9;
    EXPECT_EQ(decode_command(encoded(joint, 4)).status, CommandStatus::kBadArgument);
    joint.angle_rad = std::nan("");
    EXPECT_EQ(decode_command(encoded(joint, 4)).status, CommandStatus::kBadArgument);
}

template <class T>
T there_and_back(const T& command) {
    const DecodedCommand d = decode_command(encoded(command, 9));
    EXPECT_EQ(d.status, CommandStatus::kAccepted) << d.reason;
    return std::get<T>(d.command);
}

TEST(CommandCodec, FaultComesBackAndWildOnesAreRefused) {
    FaultCommand fault;
    fault.order = {FaultKind::kPacketDelay, 0.25, 40, 1000, 20, 2.5};
    const FaultOrder back = there_and_back(fault).order;
    EXPECT_EQ(back.kind, FaultKind::kPacketDelay);
    EXPECT_EQ(back.rate, 0.25);
    EXPECT_EQ(back.value, 40);
    EXPECT_EQ(back.from_frame, 1000u);
    EXPECT_EQ(back.frames, 20u);
    EXPECT_EQ(back.duration_s, 2.5);
    EXPECT_FALSE(there_and_back(fault).clear_all);
    fault.order.rate = 1.5;
    const DecodedCommand refused = decode_command(encoded(fault, 1));
    EXPECT_EQ(refused.status, CommandStatus::kBadArgument);
    EXPECT_EQ(refused.reason, "rate is not 0 to 1");
    fault.order = {static_cast<FaultKind>(200)};
    EXPECT_EQ(decode_command(encoded(fault, 1)).status, CommandStatus::kBadArgument);
    FaultCommand clear;
    clear.clear_all = true;
    clear.order.rate = 77;  // not looked at
    EXPECT_TRUE(there_and_back(clear).clear_all);
}

TEST(CommandCodec, ExposeModeAndSubscriptionComeBack) {
    const ExposeCommand expose = there_and_back(ExposeCommand{{-5}, 65535});
    EXPECT_EQ(expose.time.ns, -5);
    EXPECT_EQ(expose.frames, 65535);
    const TriggerModeCommand mode = there_and_back(TriggerModeCommand{true, 7});
    EXPECT_TRUE(mode.triggered);
    EXPECT_EQ(mode.burst_frames, 7);
    const SubscribeCommand wants = there_and_back(SubscribeCommand{false, true});
    EXPECT_FALSE(wants.frame_reports);
    EXPECT_TRUE(wants.housekeeping);
    auto bytes = encoded(TriggerModeCommand{}, 1);
    bytes[14] = 2;
    EXPECT_EQ(decode_command(with_crc(bytes)).status, CommandStatus::kBadArgument);
    bytes = encoded(SubscribeCommand{}, 1);
    bytes[14] = 4;
    EXPECT_EQ(decode_command(with_crc(bytes)).status, CommandStatus::kBadArgument);
}

TEST(CommandCodec, ClockComesBackAndWildOnesAreRefused) {
    using Action = ClockCommand::Action;
    const ClockCommand scale = there_and_back(ClockCommand{Action::kScale, -5, 0.25, 77});
    EXPECT_EQ(scale.action, Action::kScale);
    EXPECT_EQ(scale.sender_ns, -5);
    EXPECT_EQ(scale.scale, 0.25);
    EXPECT_EQ(scale.step_ns, 0);  // not looked at
    const ClockCommand step = there_and_back(ClockCommand{Action::kStep, 9, std::nan(""), kMaxClockStep_ns});
    EXPECT_EQ(step.step_ns, kMaxClockStep_ns);
    EXPECT_EQ(step.scale, 1);
    const auto reason = [](const ClockCommand& command) {
        return std::string(decode_command(encoded(command, 1)).reason);
    };
    for (const double wild : {0.0, -1.0, 0.0009, 1001.0, std::nan(""), HUGE_VAL})
        EXPECT_EQ(reason({Action::kScale, 0, wild, 0}), "scale of time is not 0.001 to 1000") << wild;
    for (const std::int64_t wild : {std::int64_t{0}, std::int64_t{-1}, kMaxClockStep_ns + 1})
        EXPECT_EQ(reason({Action::kStep, 0, 1, wild}), "step of time is not 1 to 1e16 ns") << wild;
    EXPECT_EQ(reason({static_cast<Action>(5), 0, 1, 0}), "action of the clock is not 0 to 4");
}

TEST(CommandCodec, LampComesBackAndALevelBeyondItsEndsIsRefused) {
    const LampCommand lamp = there_and_back(LampCommand{3, {-77}, 0.25});
    EXPECT_EQ(lamp.lamp, 3);
    EXPECT_EQ(lamp.time.ns, -77);
    EXPECT_EQ(lamp.level, 0.25);
    EXPECT_EQ(there_and_back(LampCommand{1, {}, 1}).level, 1);
    for (const double wild : {-0.01, 1.01, std::nan(""), HUGE_VAL})
        EXPECT_EQ(decode_command(encoded(LampCommand{1, {}, wild}, 1)).reason,
                  "level of a lamp is not 0 to 1")
            << wild;
}

TEST(AcknowledgementCodec, CarriesAReadingOfTheClockAfterAClockCommandAlone) {
    for (const DialectConfig& dialect : {DialectConfig{}, DialectConfig{Dialect::kCfs}}) {
        Acknowledgement a{kClockFunction, CommandStatus::kAccepted, 3, 4, {5'000'000'000}, "told"};
        ClockReading& r = a.clock.emplace();
        r.arrival.ns = 4, r.arrival_monotonic_ns = 5, r.departure_monotonic_ns = 6, r.scale = 0.1;
        r.stands_at.ns = -7;
        std::vector<std::uint8_t> bytes(kMaxPacketBytes);
        bytes.resize(encode_acknowledgement(a, 1, dialect, bytes));
        Acknowledgement back;
        ASSERT_TRUE(decode_acknowledgement(bytes, dialect, back));
        EXPECT_EQ(back.reason, "told");
        ASSERT_TRUE(back.clock);
        EXPECT_EQ(back.clock->arrival.ns, 4);
        EXPECT_EQ(back.clock->arrival_monotonic_ns, 5);
        EXPECT_EQ(back.clock->departure_monotonic_ns, 6);
        EXPECT_EQ(back.clock->departure.ns, 5'000'000'000);
        EXPECT_EQ(back.clock->scale, 0.1);
        EXPECT_EQ(back.clock->stands_at.ns, -7);
        a.function = 5;  // the same bytes behind another answer are too many
        bytes.assign(kMaxPacketBytes, 0);
        bytes.resize(encode_acknowledgement(a, 1, dialect, bytes));
        EXPECT_FALSE(decode_acknowledgement(bytes, dialect, back));
    }
}

TEST(CommandCodec, EachFaultIsRefusedByItsName) {
    const std::vector<std::uint8_t> good = encoded(some_pose(), 1);
    const auto status = [](const std::vector<std::uint8_t>& bytes) { return decode_command(bytes).status; };
    auto bad = good;
    bad[20] ^= 1;
    EXPECT_EQ(status(bad), CommandStatus::kBadChecksum);
    bad = good;
    bad[0] = 0x39;  // version 1
    EXPECT_EQ(status(with_crc(bad)), CommandStatus::kBadHeader);
    bad = good;
    bad[1] = 0x55;
    EXPECT_EQ(status(with_crc(bad)), CommandStatus::kUnknownApid);
    bad = good;
    bad[7] = 99;
    EXPECT_EQ(status(with_crc(bad)), CommandStatus::kUnknownFunction);
    bad = good;
    bad[6] = 2;
    EXPECT_EQ(status(with_crc(bad)), CommandStatus::kBadHeader);
    bad = good;
    bad.pop_back();
    EXPECT_EQ(status(bad), CommandStatus::kBadLength);
    EXPECT_EQ(status({}), CommandStatus::kBadLength);
    PoseCommand p = some_pose();
    p.motion.pose.world_from_body.w = 0.6;
    EXPECT_EQ(status(encoded(p, 1)), CommandStatus::kBadArgument);
    p = some_pose();
    p.motion.velocity_world_m_s.x = std::nan("");
    EXPECT_EQ(status(encoded(p, 1)), CommandStatus::kBadArgument);
    EXPECT_EQ(status(encoded(SettingsCommand{}, 1)), CommandStatus::kBadArgument);
}

// A hundred thousand damaged packets with valid and invalid checksums: refused or decoded, finite either way.
TEST(CommandCodec, DamagedBytesGiveFiniteCommandsOrRefusals) {
    std::uint32_t state = 12345;
    const auto next = [&] { return (state = state * 1664525u + 1013904223u) >> 8; };
    for (int i = 0; i < 100000; ++i) {
        std::vector<std::uint8_t> bytes = encoded(some_pose(), 1);
        bytes.resize(next() % 3 == 0 ? next() % bytes.size() : bytes.size());
        for (std::uint32_t k = next() % 8; k > 0 && !bytes.empty(); --k)
            bytes[next() % bytes.size()] = static_cast<std::uint8_t>(next());
        if (next() % 2 && bytes.size() > 2) bytes = with_crc(bytes);
        const DecodedCommand d = decode_command(bytes);
        if (d.status != CommandStatus::kAccepted) continue;
        if (const auto* p = std::get_if<PoseCommand>(&d.command)) {
            ASSERT_TRUE(is_finite(p->motion.pose.position_world_m) &&
                        is_finite(p->motion.velocity_world_m_s));
            ASSERT_NEAR(norm(p->motion.pose.world_from_body), 1, 1e-12);
        }
    }
}

TEST(CommandsUdp, AnswersCountsAndSeparatesPackets) {
    CommandRecorder recorder;
    UdpCommandReceiver receiver({"127.0.0.1", 15010}, recorder);
    receiver.start();
    CommandSender sender("127.0.0.1:15010");
    EXPECT_EQ(sender.send(PingCommand{9}).token, 9u);
    EXPECT_EQ(sender.send(PingCommand{9}).simulated_time.ns, 42);
    EXPECT_FALSE(sender.send(PingCommand{9}).clock);
    const std::int64_t sent_ns = monotonic_ns();
    const Acknowledgement clock = sender.send(ClockCommand{ClockCommand::Action::kAsk, -3, 1, 0});
    EXPECT_EQ(clock.token, static_cast<std::uint64_t>(-3));
    ASSERT_TRUE(clock.clock);
    EXPECT_GE(clock.clock->arrival_monotonic_ns, sent_ns);
    EXPECT_LE(clock.clock->arrival_monotonic_ns, monotonic_ns());
    PoseCommand pose = some_pose();
    pose.object = 3;
    EXPECT_EQ(sender.send(pose).status, CommandStatus::kUnknownObject);

    // Two packets in one datagram, then rubbish, then a gap in the sequence.
    const Fd socket = open_udp(0x7F000001, 0);
    const sockaddr_in to = parse_endpoint("127.0.0.1:15010");
    std::vector<std::uint8_t> bytes = encoded(StartCommand{}, 0);
    const auto second = encoded(StopCommand{}, 5);
    bytes.insert(bytes.end(), second.begin(), second.end());
    bytes.insert(bytes.end(), {1, 2, 3});
    sendto(socket.get(), bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
    std::array<std::uint8_t, 256> answer;
    Acknowledgement a;
    std::vector<CommandStatus> statuses;
    for (int i = 0; i < 3; ++i) {
        const auto got = recv(socket.get(), answer.data(), answer.size(), 0);
        ASSERT_TRUE(decode_acknowledgement({answer.data(), static_cast<std::size_t>(got)}, a));
        statuses.push_back(a.status);
    }
    EXPECT_EQ(statuses,
              (std::vector{CommandStatus::kAccepted, CommandStatus::kAccepted, CommandStatus::kBadLength}));
    EXPECT_FALSE(a.reason.empty());
    const CommandReport report = receiver.report();
    EXPECT_EQ(report.received, 8u);
    EXPECT_EQ(report.refused, 2u);
    EXPECT_EQ(report.lost, 4u);
    receiver.stop();
}

TEST(CommandsUdp, BusyPortSaysWhichAndWhatToDo) {
    CommandRecorder recorder;
    const Fd taken = open_udp(0x7F000001, 15011);
    UdpCommandReceiver receiver({"127.0.0.1", 15011}, recorder);
    try {
        receiver.start();
        FAIL();
    } catch (const DeviceError& error) {
        EXPECT_THAT(error.what(),
                    testing::HasSubstr("UDP 127.0.0.1:15011 is taken by another program; stop it"));
    }
}

TEST(CommandSender, SilenceIsAnErrorThatNamesTheEndpoint) {
    EXPECT_THROW(CommandSender("127.0.0.1"), InputError);
    const Fd silent = open_udp(0x7F000001, 15012);
    EXPECT_THROW(CommandSender("127.0.0.1:15012").send(PingCommand{}, 50), DeviceError);
}

}  // namespace
}  // namespace hilcam
