#include <gmock/gmock.h>

#include <random>

#include "io/commands/command_station.h"
#include "io/commands/packet_stream.h"
#include "io/commands/sequence_window.h"
#include "tests/support/commands.h"

namespace hilcam {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Kind = PacketStream::Item::Kind;
const Bytes kMarker = {0x1A, 0xCF, 0xFC, 0x1D};

struct Taken {
    std::vector<std::uint32_t> packets;  // sequence numbers
    int broken = 0;
};
// Everything that a stream makes of bytes that come in pieces of a size.
Taken taken(PacketStream& stream, std::span<const std::uint8_t> bytes, std::size_t piece) {
    Taken out;
    while (!bytes.empty()) {
        const std::size_t size = std::min(piece, bytes.size());
        std::copy_n(bytes.begin(), size, stream.room().begin());
        stream.filled(size);
        bytes = bytes.subspan(size);
        for (auto item = stream.next(); item.kind != Kind::kNothing; item = stream.next()) {
            if (item.kind == Kind::kBroken)
                ++out.broken;
            else
                out.packets.push_back(decode_command(item.bytes).sequence);
        }
    }
    return out;
}
PacketStream command_stream() { return PacketStream(command_rule({})); }

TEST(PacketStream, PiecesOfAnySizeGiveTheSamePackets) {
    Bytes bytes;
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < 40; ++i) {
        bytes = bytes + (i % 3 == 0 ? kMarker : Bytes{}) +
                encoded(i % 2 ? Command(some_pose()) : StartCommand{}, i);
        expected.push_back(i);
    }
    for (const std::size_t piece : {1u, 2u, 3u, 5u, 7u, 64u, 500u, 16384u}) {
        PacketStream stream = command_stream();
        const Taken t = taken(stream, bytes, piece);
        EXPECT_EQ(t.packets, expected) << piece;
        EXPECT_EQ(t.broken, 0) << piece;
        EXPECT_EQ(stream.skipped_bytes(), 0u) << piece;
    }
}

TEST(PacketStream, GarbageIsGivenOutOnceAndTheNextPacketsAreFound) {
    const Bytes good = encoded(some_pose(), 7);
    const Bytes garbage = {0xFF, 0x19, 0x00, 1, 2, 3, 0x19, 0x00, 0xC0, 0x00, 0x00, 0x30, 9};
    for (const std::size_t piece : {1u, 4u, 1000u}) {
        PacketStream stream = command_stream();
        const Taken t = taken(stream, good + garbage + good + good, piece);
        EXPECT_THAT(t.packets, testing::ElementsAre(7, 7, 7)) << piece;
        EXPECT_EQ(t.broken, 1) << piece;
        EXPECT_EQ(stream.skipped_bytes(), garbage.size()) << piece;
    }
}

TEST(PacketStream, ADamagedPacketCostsItselfAlone) {
    const Bytes good = encoded(some_pose(), 7);
    for (std::size_t at = 0; at < good.size(); ++at) {
        Bytes damaged = good;
        damaged[at] ^= 0x40;
        PacketStream stream = command_stream();
        const Taken t = taken(stream, good + damaged + good, 33);
        EXPECT_THAT(t.packets, testing::ElementsAre(7, 7)) << "byte " << at;
        EXPECT_EQ(t.broken, 1) << "byte " << at;
    }
}

// A length field that says more than came must not hold back the packet behind it until that many came.
TEST(PacketStream, AWrongLengthDoesNotHoldUpTheNextPacket) {
    Bytes longer = encoded(StartCommand{}, 1);
    longer[5] = 0xF0;
    PacketStream stream = command_stream();
    const Taken t = taken(stream, longer + encoded(StopCommand{}, 2), 1);
    EXPECT_THAT(t.packets, testing::ElementsAre(2));
    EXPECT_EQ(t.broken, 1);
}

TEST(PacketStream, AForeignPacketThatIsWholeKeepsTheStep) {
    Bytes foreign = encoded(StartCommand{}, 1);
    foreign[1] = 0x55;
    PacketStream stream = command_stream();
    const Bytes bytes = with_crc(foreign) + encoded(StopCommand{}, 2);
    std::copy(bytes.begin(), bytes.end(), stream.room().begin());
    stream.filled(bytes.size());
    PacketStream::Item item = stream.next();
    EXPECT_EQ(item.kind, Kind::kPacket);
    EXPECT_EQ(decode_command(item.bytes).status, CommandStatus::kUnknownApid);
    EXPECT_EQ(stream.next().kind, Kind::kPacket);
    EXPECT_EQ(stream.skipped_bytes(), 0u);
}

TEST(PacketStream, TheEndGivesOutWhatIsLeftAndStartsAnew) {
    PacketStream stream = command_stream();
    const Bytes bytes = encoded(some_pose(), 1);
    EXPECT_EQ(taken(stream, std::span(bytes).first(50), 50).packets.size(), 0u);
    const PacketStream::Item rest = stream.end();
    EXPECT_EQ(rest.kind, Kind::kBroken);
    EXPECT_EQ(rest.bytes.size(), 50u);
    EXPECT_EQ(stream.end().kind, Kind::kNothing);
    EXPECT_THAT(taken(stream, bytes, 1000).packets, testing::ElementsAre(1));
}

// Packets between random garbage: all of them come out, in order.
TEST(PacketStream, LosesNoPacketAmongRandomGarbage) {
    std::mt19937 random(3);
    PacketStream stream = command_stream();
    Taken all;
    std::vector<std::uint32_t> sent;
    for (std::uint32_t i = 0; i < 3000; ++i) {
        Bytes bytes(random() % 40);
        for (auto& b : bytes) b = static_cast<std::uint8_t>(random() % 4 == 0 ? 0x19 : random() % 256);
        const Taken t = taken(stream, bytes + encoded(PingCommand{i}, i), 1 + random() % 60);
        all.packets.insert(all.packets.end(), t.packets.begin(), t.packets.end());
        sent.push_back(i);
    }
    EXPECT_EQ(all.packets, sent);
}

using Finding = SequenceWindow::Finding::Kind;

TEST(SequenceWindow, TellsGapsLateOnesAndDuplicates) {
    SequenceWindow window;
    EXPECT_EQ(window.take(10).kind, Finding::kNext);  // the first may be any
    EXPECT_EQ(window.take(11).kind, Finding::kNext);
    const auto gap = window.take(15);
    EXPECT_EQ(gap.kind, Finding::kGap);
    EXPECT_EQ(gap.lost, 3u);
    EXPECT_EQ(window.take(13).kind, Finding::kLate);
    EXPECT_EQ(window.take(13).kind, Finding::kDuplicate);
    EXPECT_EQ(window.take(15).kind, Finding::kDuplicate);
    EXPECT_EQ(window.take(16).kind, Finding::kNext);
    EXPECT_EQ(window.take(0).kind, Finding::kNext);  // begins anew
    EXPECT_EQ(window.take(1).kind, Finding::kNext);
    EXPECT_EQ(window.take(5000).kind, Finding::kGap);
    EXPECT_EQ(window.take(4000).kind, Finding::kNext);  // too far back to be late
}

// Programs that send one command each and number it by the clock.
TEST(SequenceWindow, AJumpThatNoLineLosesIsASenderThatBeginsAnew) {
    SequenceWindow window;
    EXPECT_EQ(window.take(7).kind, Finding::kNext);
    EXPECT_EQ(window.take(7 + (1u << 20)).lost, (1u << 20) - 1);
    EXPECT_EQ(window.take(8 + (2u << 20)).kind, Finding::kNext);
    EXPECT_EQ(window.take(9 + (2u << 20)).kind, Finding::kNext);
    EXPECT_EQ(window.take(0x90000000u).kind, Finding::kNext);
}

TEST(SequenceWindow, WrapsWithItsBits) {
    SequenceWindow window(14);
    EXPECT_EQ(window.take(16382).kind, Finding::kNext);
    EXPECT_EQ(window.take(16383).kind, Finding::kNext);
    EXPECT_EQ(window.take(0).kind, Finding::kNext);
    const auto gap = window.take(2);
    EXPECT_EQ(gap.kind, Finding::kGap);
    EXPECT_EQ(gap.lost, 1u);
    EXPECT_EQ(window.take(1).kind, Finding::kLate);
    EXPECT_EQ(window.take(16383).kind, Finding::kDuplicate);
}

class StationTest : public testing::Test {
  protected:
    std::vector<Acknowledgement> answers(const Bytes& bytes, std::int64_t arrival_ns) {
        std::vector<Acknowledgement> out;
        std::copy(bytes.begin(), bytes.end(), stream.room().begin());
        stream.filled(bytes.size());
        station.take(stream, arrival_ns, sender, [&](std::span<const std::uint8_t> packet) {
            EXPECT_TRUE(decode_acknowledgement(packet, out.emplace_back()));
        });
        return out;
    }
    CommandRecorder recorder;
    CommandStation station{recorder, {}};
    CommandStation::Sender& sender = station.open("a");
    PacketStream stream = station.make_stream();
};

TEST_F(StationTest, ARetriedExposeIsAnsweredAndNotDoneAgain) {
    const Bytes expose = encoded(ExposeCommand{{}, 1}, 5);
    EXPECT_EQ(answers(expose + expose, 0).size(), 2u);
    EXPECT_EQ(recorder.commands().size(), 1u);
    // Another in between does not change that; more than a second does, and so do other bytes.
    answers(encoded(some_pose(), 6) + expose, 900'000'000);
    EXPECT_EQ(recorder.commands().size(), 2u);
    answers(expose, 1'100'000'000);
    EXPECT_EQ(recorder.commands().size(), 3u);
    answers(encoded(ExposeCommand{{}, 2}, 5), 1'100'000'000);
    EXPECT_EQ(recorder.commands().size(), 4u);
    EXPECT_EQ(station.report().duplicates, 4u);
    EXPECT_EQ(station.report().lost, 0u);
}

TEST_F(StationTest, ARetriedFaultOrStepIsNotDoneAgainAndAScaleIs) {
    using Action = ClockCommand::Action;
    FaultOrder three_frames{FaultKind::kImageBlack, 1, 0, 0, 3, 0};
    std::uint32_t sequence = 5;
    for (const Command& command :
         {Command(FaultCommand{three_frames, false}), Command(ClockCommand{Action::kStep, 0, 1, 1000})}) {
        const std::size_t before = recorder.commands().size();
        const Bytes packet = encoded(command, sequence++);
        EXPECT_EQ(answers(packet + packet, 0).size(), 2u);
        EXPECT_EQ(recorder.commands().size(), before + 1);
    }
    // Another sender's are its own.
    CommandStation::Sender& other = station.open("b");
    PacketStream others = station.make_stream();
    const Bytes step = encoded(ClockCommand{Action::kStep, 0, 1, 1000}, 6);
    std::copy(step.begin(), step.end(), others.room().begin());
    others.filled(step.size());
    station.take(others, 0, other, [](std::span<const std::uint8_t>) {});
    EXPECT_EQ(recorder.commands().size(), 3u);
    // What comes to the same when it is done twice is done twice.
    const Bytes scale = encoded(ClockCommand{Action::kScale, 0, 2, 0}, 7);
    answers(scale + scale, 0);
    EXPECT_EQ(recorder.commands().size(), 5u);
}

TEST_F(StationTest, CommandsAreCarriedOutAsTheyArriveWhateverTheirNumbers) {
    const auto out = answers(encoded(some_pose(), 9) + encoded(StopCommand{}, 7) +
                                 encoded(StartCommand{}, 8) + encoded(some_pose(), 2),
                             0);
    ASSERT_EQ(out.size(), 4u);
    EXPECT_EQ(out[3].sequence, 2u);
    EXPECT_THAT(recorder.sequences(), testing::ElementsAre(9, 7, 8, 2));
}

// From a packet too short to say what it is.
TEST_F(StationTest, WhoseNumberIsNotThereIsAnsweredWithNoughts) {
    std::vector<Acknowledgement> out;
    const Bytes bytes = {0x19, 0x00, 0xC0, 0x05, 0x00, 0x01, 0x01};
    std::copy(bytes.begin(), bytes.end(), stream.room().begin());
    stream.filled(bytes.size());
    station.take_all(stream, 0, sender, [&](std::span<const std::uint8_t> packet) {
        EXPECT_TRUE(decode_acknowledgement(packet, out.emplace_back()));
    });
    ASSERT_EQ(out.size(), 1u);
    EXPECT_NE(out[0].status, CommandStatus::kAccepted);
    EXPECT_EQ(out[0].function, 0);
    EXPECT_EQ(out[0].sequence, 0u);
    EXPECT_EQ(recorder.commands().size(), 0u);
    EXPECT_EQ(station.report().refused, 1u);
}

TEST_F(StationTest, CountsBySenderAndAnswersBrokenBytesOnce) {
    CommandStation::Sender& other = station.open("b");
    Bytes bad = encoded(some_pose(), 1);
    bad[20] ^= 1;
    const auto a = answers(encoded(StartCommand{}, 0) + bad + encoded(StopCommand{}, 4), 0);
    ASSERT_EQ(a.size(), 3u);
    EXPECT_EQ(a[1].status, CommandStatus::kBadChecksum);
    EXPECT_EQ(a[1].function, 1);
    EXPECT_EQ(a[2].status, CommandStatus::kAccepted);
    const auto senders = station.senders();
    ASSERT_EQ(senders.size(), 2u);
    EXPECT_EQ(senders[0].received, 3u);
    EXPECT_EQ(senders[0].refused, 1u);
    EXPECT_EQ(senders[0].lost, 3u);
    EXPECT_EQ(senders[1].received, 0u);
    EXPECT_EQ(station.report().skipped_bytes, bad.size());
    station.close(other);
    EXPECT_EQ(station.report().clients, 1u);
}

TEST_F(StationTest, WhatIsRefusedIsNotLost) {
    Bytes odd = encoded(PingCommand{1}, 6);
    odd[7] = 200;  // no such function
    odd.resize(odd.size() - 2);
    const std::uint16_t crc = crc16(odd);
    odd.push_back(static_cast<std::uint8_t>(crc >> 8)), odd.push_back(static_cast<std::uint8_t>(crc));
    const auto out = answers(encoded(PingCommand{1}, 5) + odd + encoded(PingCommand{1}, 7), 0);
    ASSERT_EQ(out.size(), 3u);
    EXPECT_EQ(out[1].status, CommandStatus::kUnknownFunction);
    EXPECT_EQ(out[1].sequence, 6u);
    EXPECT_EQ(station.report().refused, 1u);
    EXPECT_EQ(station.report().lost, 0u);
    Bytes damaged = encoded(PingCommand{1}, 8);
    damaged.back() ^= 1;  // nobody knows what its number was
    answers(damaged + encoded(PingCommand{1}, 9), 0);
    EXPECT_EQ(station.report().lost, 1u);
}

TEST_F(StationTest, TelemetryGoesToSubscribersOfItsKindAlone) {
    answers(encoded(SubscribeCommand{true, false}, 0), 0);
    station.open("b");
    int told = 0;
    const CommandStation::Notify notify = [&](CommandStation::Sender& to,
                                              std::span<const std::uint8_t> packet) {
        EXPECT_EQ(&to, &sender);
        Telemetry telemetry;
        ASSERT_TRUE(decode_telemetry(packet, telemetry));
        EXPECT_EQ(std::get<FrameReport>(telemetry).frame, 3u);
        ++told;
    };
    FrameReport report;
    report.frame = 3;
    station.notify(report, notify);
    station.notify(HousekeepingFigures{}, notify);
    EXPECT_EQ(told, 1);
    answers(encoded(SubscribeCommand{}, 1), 0);
    station.notify(report, notify);
    EXPECT_EQ(told, 1);
}

// Counts begin at 0 for each subscriber, and each kind of telemetry has its own count.
TEST_F(StationTest, TelemetryIsCountedByReceiverAndKind) {
    CommandStation::Sender& later = station.open("b");
    station.subscribe(sender, {true, true});
    std::vector<int> reports, housekeepings, of_later;
    const auto send = [&](const Telemetry& telemetry, std::vector<int>& counts) {
        station.notify(telemetry, [&](CommandStation::Sender& to, std::span<const std::uint8_t> packet) {
            (&to == &sender ? counts : of_later).push_back((packet[2] & 0x3F) << 8 | packet[3]);
        });
    };
    send(FrameReport{}, reports);
    send(FrameReport{}, reports);
    send(HousekeepingFigures{}, housekeepings);
    station.subscribe(later, {true, false});
    send(FrameReport{}, reports);
    send(HousekeepingFigures{}, housekeepings);
    EXPECT_THAT(reports, testing::ElementsAre(0, 1, 2));
    EXPECT_THAT(housekeepings, testing::ElementsAre(0, 1));
    EXPECT_THAT(of_later, testing::ElementsAre(0));
    // 14 bits.
    for (int i = 3; i < 16384; ++i) send(FrameReport{}, reports);
    EXPECT_EQ(reports.back(), 16383);
    send(FrameReport{}, reports);
    EXPECT_EQ(reports.back(), 0);
}

}  // namespace
}  // namespace hilcam
