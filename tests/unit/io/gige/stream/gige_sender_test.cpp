// The stream over real sockets, received by a plain program of this test.

#include "io/gige/stream/gige_sender.h"

#include <gmock/gmock.h>
#include <poll.h>

#include <array>
#include <chrono>
#include <map>
#include <thread>

#include "io/gige/stream/gige_frame_writer.h"
#include "tests/support/gvsp_receiver.h"

namespace hilcam {
namespace {

constexpr int kSentWidth = 64, kSentHeight = 48;
constexpr std::uint32_t kHere = 0x7F530101;  // 127.83.1.1

class Sender : public testing::TestWithParam<bool> {
  protected:
    FaultBoard faults_{3};
    GigeRing ring_{GigeRing::kMinSlots, max_payload_bytes(kSentWidth, kSentHeight, "", false)};
    DeviceClock clock_;
    GigeFrameWriter writer_{ring_, faults_, clock_, "", kSentWidth};
    std::atomic<std::uint64_t> finished_{0};
    GigeSender sender_{ring_, faults_, nullptr, {}, [this](std::uint64_t a) { finished_ = a; }};
    Fd client_ = open_udp(kHere, 0);
    GigeStreamNow now_;
    DnImage image_{kSentWidth, kSentHeight};
    FrameRecord record_;
    // What came, by block and packet id; the last one counts.
    std::map<std::uint64_t, std::map<std::uint32_t, Packet>> came_;
    int duplicates_ = 0;

    void SetUp() override {
        sender_.open(kHere);
        GigeStreamState& s = now_.state;
        s.open = s.acquiring = true;
        s.destination = endpoint_of(client_);
        s.packet_bytes = 576;
        s.extended_ids = GetParam();
        s.format = WireFormat::kMono12;
        s.width = kSentWidth, s.height = kSentHeight;
        now_.acquisition = 1;
        record_.bits = 12;
        sender_.set_stream(now_);
        sender_.start();
    }
    void TearDown() override { sender_.close(); }

    std::uint32_t trailer() const { return trailer_id(now_.state); }
    GigeFrameWriter::Outcome write() {
        return writer_.write(image_, record_, now_, writer_.admit(image_, record_, now_));
    }
    // Publishes a frame and waits until the sender is through with it.
    void send_frame() {
        ++record_.id;
        for (std::uint16_t& dn : image_.all()) dn = static_cast<std::uint16_t>(record_.id);
        const std::uint64_t before = sender_.counts().frames;
        ASSERT_TRUE(write().written);
        sender_.frame_ready();
        for (int i = 0; i < kPatience_ms && sender_.counts().frames == before; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        ASSERT_GT(sender_.counts().frames, before);
        take(0);
    }
    // Takes packets until none comes for so long.
    void take(int patience_ms) {
        while (true) {
            const auto bytes = receive(client_, patience_ms);
            if (bytes.empty()) return;
            Packet p = parse(bytes);
            duplicates_ += came_[p.block].contains(p.id);
            came_[p.block][p.id] = std::move(p);
        }
    }
    // Asks and waits for an answer.
    Packet ask(std::uint64_t block, std::uint32_t first, std::uint32_t last) {
        EXPECT_TRUE(sender_.order({.kind = GigeOrder::Kind::kResend,
                                   .to = now_.state.destination,
                                   .acquisition = now_.acquisition,
                                   .block = block,
                                   .next = first,
                                   .last = last,
                                   .extended_ids = now_.state.extended_ids,
                                   .packet_bytes = now_.state.packet_bytes}));
        const auto bytes = receive(client_, kPatience_ms);
        EXPECT_FALSE(bytes.empty());
        if (bytes.empty()) return {};
        const Packet p = parse(bytes);
        came_[p.block][p.id] = p;
        return p;
    }
    std::vector<std::uint8_t> payload(std::uint64_t block) {
        std::vector<std::uint8_t> out;
        for (std::uint32_t id = 1; id < trailer(); ++id)
            out.insert(out.end(), came_[block][id].data.begin(), came_[block][id].data.end());
        return out;
    }
    static std::vector<std::uint8_t> expected(std::uint64_t frame) {
        std::vector<std::uint8_t> out(std::size_t{2} * kSentWidth * kSentHeight);
        for (std::size_t i = 0; i < out.size(); i += 2) out[i] = static_cast<std::uint8_t>(frame);
        return out;
    }
};

TEST_P(Sender, FramesComeWhole) {
    for (std::uint64_t block = 1; block <= 5; ++block) {
        send_frame();
        ASSERT_EQ(came_[block].size(), trailer() + 1) << block;
        EXPECT_EQ(came_[block][0].format, gvsp::kLeader);
        EXPECT_EQ(came_[block][trailer()].format, gvsp::kTrailer);
        EXPECT_EQ(payload(block), expected(block));
    }
    EXPECT_EQ(sender_.counts().packets, 5 * (trailer() + 1));
}

TEST_P(Sender, WhatIsLostIsHadByAskingAgain) {
    faults_.order({.kind = FaultKind::kPacketDrop, .rate = 0.3});
    for (std::uint64_t block = 1; block <= 8; ++block) {
        send_frame();
        ASSERT_LT(came_[block].size(), trailer() + 1);
        for (std::uint32_t id = 0; id <= trailer(); ++id) {
            if (came_[block].contains(id)) continue;
            const Packet p = ask(block, id, id);
            EXPECT_EQ(p.status, gvsp::kResent);
            EXPECT_EQ(p.flags, GetParam() ? 1u : 0u);
            EXPECT_EQ(p.id, id);
        }
        EXPECT_EQ(payload(block), expected(block));
    }
    EXPECT_EQ(sender_.counts().packets_resent, sender_.counts().packets_dropped);
    EXPECT_EQ(sender_.counts().packets_refused, 0u);
}

TEST_P(Sender, ARangeIsSentToTheBlocksEnd) {
    send_frame();
    came_.clear();
    ask(1, 2, 0xFFFFFF);
    take(200);
    EXPECT_EQ(came_[1].size(), trailer() - 1);
}

TEST_P(Sender, DamageIsOnTheWireOnly) {
    struct Row {
        FaultKind kind;
        double value;
    };
    for (const Row& row : {Row{FaultKind::kPacketCorrupt, 0},
                           {FaultKind::kPacketTruncate, 100},
                           {FaultKind::kPacketWrongId, 1000}}) {
        faults_.order({.kind = row.kind, .rate = 1, .value = row.value});
        send_frame();
        const std::uint64_t block = record_.id;
        EXPECT_NE(payload(block), expected(block)) << name_of(row.kind);
        if (row.kind == FaultKind::kPacketCorrupt) {
            // One byte of each packet, inverted.
            const auto got = payload(block), right = expected(block);
            int wrong = 0;
            for (std::size_t i = 0; i < got.size(); ++i)
                wrong += got[i] == static_cast<std::uint8_t>(~right[i]);
            EXPECT_EQ(wrong, static_cast<int>(trailer()) - 1);
        }
        for (std::uint32_t id = 1; id < trailer(); ++id) ask(block, id, id);
        EXPECT_EQ(payload(block), expected(block)) << name_of(row.kind);
        faults_.clear_all();
    }
}

TEST_P(Sender, TwiceLateAndInAnotherOrder) {
    faults_.order({.kind = FaultKind::kPacketDuplicate, .rate = 1});
    faults_.order({.kind = FaultKind::kPacketReorder, .rate = 0.5});
    send_frame();
    EXPECT_EQ(payload(1), expected(1));
    EXPECT_EQ(duplicates_, static_cast<int>(trailer()) + 1);
    faults_.clear_all();
    faults_.order({.kind = FaultKind::kPacketDelay, .rate = 1, .value = 30});
    send_frame();
    faults_.clear_all();
    while (came_[2].size() <= trailer()) {
        const std::size_t before = came_[2].size();
        take(500);
        ASSERT_GT(came_[2].size(), before);
    }
    EXPECT_EQ(payload(2), expected(2));
}

TEST_P(Sender, WhatCannotBeHadIsRefusedWithTheReason) {
    for (int i = 0; i < 30; ++i) send_frame();
    EXPECT_EQ(ask(30, 1, 1).status, gvsp::kResent);
    EXPECT_EQ(ask(30 - GigeRing::kMinKept + 1, 1, 1).status, gvsp::kResent);
    EXPECT_EQ(ask(2, 1, 1).status, gvsp::kRemovedWithAllBefore);
    EXPECT_EQ(ask(31, 1, 1).status, gvsp::kNotYetAvailable);
    EXPECT_EQ(ask(30, trailer() + 1, trailer() + 5).status, gvsp::kUnavailable);
    take(100);
    faults_.order({.kind = FaultKind::kFrameDrop, .rate = 1});
    ++record_.id;
    EXPECT_FALSE(write().written);
    faults_.clear_all();
    send_frame();
    EXPECT_EQ(ask(31, 1, 1).status, gvsp::kUnavailable);  // it never was
    faults_.order({.kind = FaultKind::kResendRefused, .rate = 1});
    EXPECT_EQ(ask(32, 1, 1).status, gvsp::kUnavailable);
    faults_.clear_all();
    EXPECT_EQ(ask(32, 1, 1).status, gvsp::kResent);
    EXPECT_GE(sender_.counts().packets_refused, 5u);
}

TEST_P(Sender, ABlockIsSentAgainSoOftenAndThenRefused) {
    send_frame();
    const std::uint64_t packets = trailer() + 1;
    for (std::uint64_t i = 0; i < GigeSender::kMaxResent; ++i) {
        EXPECT_EQ(ask(1, 0, 0xFFFFFF).status, gvsp::kResent);
        take(100);
    }
    EXPECT_EQ(ask(1, 0, 0xFFFFFF).status, gvsp::kUnavailable);
    EXPECT_EQ(ask(1, 3, 3).status, gvsp::kUnavailable);
    take(100);
    EXPECT_EQ(sender_.counts().packets_resent, GigeSender::kMaxResent * packets);
    EXPECT_EQ(sender_.counts().packets_over_limit, packets + 1);
    // Another block has a share of its own, and refusals end.
    send_frame();
    EXPECT_EQ(ask(2, 1, 1).status, gvsp::kResent);
    constexpr int kRequests = 1000;
    for (int i = 0; i < kRequests; ++i) {
        GigeOrder order{.to = now_.state.destination, .acquisition = 1, .block = 1, .next = 1, .last = 1};
        order.extended_ids = GetParam(), order.packet_bytes = now_.state.packet_bytes;
        sender_.order(order);
    }
    take(100);
    EXPECT_GT(sender_.counts().requests_unanswered, 0u);
}

// Each block of them has a share of its own, but all together have no more than the stream's budget.
TEST_P(Sender, ManyBlocksAreNotSentAgainMoreOftenThanTheStreamEarns) {
    for (std::size_t i = 0; i < GigeRing::kMinKept; ++i) send_frame();
    const std::uint64_t packets = trailer() + 1;
    for (std::uint64_t block = 1; block <= GigeRing::kMinKept; ++block)
        for (int i = 0; i < 3; ++i) {
            ask(block, 0, 0xFFFFFF);
            take(20);
        }
    EXPECT_EQ(sender_.counts().packets_resent, ResendBudget::kSavedFrames * packets);
    EXPECT_GT(sender_.counts().packets_over_limit, 0u);
    send_frame();
    for (int i = 0; i < 3; ++i) {
        ask(1, 0, 0xFFFFFF);
        take(20);
    }
    EXPECT_EQ(sender_.counts().packets_resent, (ResendBudget::kSavedFrames + 1) * packets);
}

// Nobody listens there, so nothing is known of the receiver's room, as of one on another machine. Exposures are 1000 s
// apart: the turn of a late frame never comes in this test.
class LateFrames : public Sender {
  protected:
    static constexpr std::int64_t kApart_ns = 1'000'000'000'000;
    void SetUp() override {
        Sender::SetUp();
        now_.state.destination = {kHere + 8, 40000};
        ++now_.acquisition;
        record_.exposure_mid_monotonic_ns = -100 * kApart_ns;
        sender_.set_stream(now_);
    }
    void write_late() {
        ++record_.id;
        record_.exposure_mid_monotonic_ns += kApart_ns;
        ASSERT_TRUE(write().written);
        sender_.frame_ready();
    }
    bool eventually(const std::atomic<std::uint64_t>& count, std::uint64_t wanted) {
        return eventually([&] { return count.load(); }, wanted);
    }
    bool eventually(const LossCount& count, std::uint64_t wanted) {
        return eventually([&] { return count.count(); }, wanted);
    }
    template <class Count>
    bool eventually(const Count& count, std::uint64_t wanted) {
        for (int i = 0; i < kPatience_ms && count() < wanted; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return count() == wanted;
    }
};

TEST_P(LateFrames, OneIsSentOneWaitsForItsTurnAndOneBehindIt) {
    write_late();
    ASSERT_TRUE(eventually(sender_.counts().frames, 1));
    for (std::uint64_t i = 0; i < 10; ++i) {
        write_late();
        // Each after the second makes the oldest one go.
        ASSERT_TRUE(eventually(sender_.counts().frames_given_up, i > 1 ? i - 1 : 0));
    }
    EXPECT_EQ(sender_.counts().frames, 1u);
    EXPECT_EQ(sender_.counts().frames_spaced, 1u);
    EXPECT_EQ(ring_.waiting(), 1 + FrameSpacing::kMaxQueued);
}

TEST_P(LateFrames, TheyAreNotWaitedForOnceTheClientIsGone) {
    write_late();
    ASSERT_TRUE(eventually(sender_.counts().frames, 1));
    write_late();
    write_late();
    ASSERT_TRUE(eventually(sender_.counts().frames_spaced, 1));
    now_.state.open = false;
    sender_.set_stream(now_);
    for (int i = 0; i < kPatience_ms && ring_.waiting() > 0; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_EQ(ring_.waiting(), 0u);
    EXPECT_EQ(sender_.counts().frames, 1u);
}

TEST_P(LateFrames, InLockstepNoneIsLate) {
    GigeSender other(ring_, faults_, nullptr, {.space_late_frames = false}, [](std::uint64_t) {});
    sender_.close();
    other.open(kHere);
    other.set_stream(now_);
    other.start();
    for (std::uint64_t i = 1; i <= 5; ++i) {
        ++record_.id;
        record_.exposure_mid_monotonic_ns += kApart_ns;
        ASSERT_TRUE(write().written);
        other.frame_ready();
        ASSERT_TRUE(eventually(other.counts().frames, i));
    }
    EXPECT_EQ(other.counts().frames_spaced, 0u);
}

TEST_P(Sender, TestPacketsHaveTheSizeAskedFor) {
    const auto test = [&](std::uint32_t bytes) {
        GigeOrder order;
        order.kind = GigeOrder::Kind::kTestPacket;
        order.to = now_.state.destination;
        order.packet_bytes = bytes;
        order.do_not_fragment = true;
        sender_.order(order);
        return receive(client_, bytes == 4004 ? 100 : kPatience_ms).size();
    };
    EXPECT_EQ(test(1500), 1472u);
    EXPECT_EQ(test(576), 548u);
    EXPECT_EQ(test(9000), 8972u);
    // A packet is counted once the kernel has it, and may be here before.
    const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(kPatience_ms);
    while (sender_.counts().test_packets < 3 && std::chrono::steady_clock::now() < until)
        std::this_thread::yield();
    EXPECT_EQ(sender_.counts().test_packets, 3u);
    faults_.order({.kind = FaultKind::kLinkDown, .rate = 1});
    EXPECT_EQ(test(4004), 0u);
}

// A client tries sizes until one is too long: that takes nothing away from a frame.
TEST_P(Sender, ATestPacketThatTheKernelRefusesIsNoPacketOfAFrame) {
    GigeOrder order;
    order.kind = GigeOrder::Kind::kTestPacket;
    order.to = now_.state.destination;
    order.packet_bytes = 1500;
    order.to.ip = 0xC6336401;  // 198.51.100.1 (RFC 5737): no way from a loopback address
    sender_.order(order);
    for (int i = 0; i < kPatience_ms && sender_.counts().test_packets_failed == 0; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_EQ(sender_.counts().test_packets_failed, 1u);
    EXPECT_EQ(sender_.counts().packets_failed.count(), 0u);
}

TEST_P(Sender, PacketsThatTheKernelRefusesAreCountedWithTheirFirstFrame) {
    send_frame();
    EXPECT_EQ(sender_.counts().packets_failed.count(), 0u);
    now_.state.destination.ip = 0xC6336401;
    sender_.set_stream(now_);
    for (int i = 0; i < 2; ++i) {
        ++record_.id;
        ASSERT_TRUE(write().written);
        sender_.frame_ready();
    }
    const std::uint64_t all = 2 * (std::uint64_t{trailer()} + 1);
    for (int i = 0; i < kPatience_ms && sender_.counts().packets_failed.count() < all; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_EQ(sender_.counts().packets_failed.count(), all);
    EXPECT_EQ(sender_.counts().packets_failed.first(), 2u);
}

// A camera that is to move opens what it will send from, or learns that it cannot, while it still sends from where it is.
TEST_P(Sender, AnotherAddressIsOpenedBesideTheOneInUse) {
    constexpr std::uint32_t kThere = 0x7F530102, kNobodys = 0xC0000201;  // 127.83.1.2; 192.0.2.1 (RFC 5737)
    const auto sent_from = [&] {
        GigeOrder order;
        order.kind = GigeOrder::Kind::kTestPacket;
        order.to = now_.state.destination;
        order.packet_bytes = 576;
        sender_.order(order);
        pollfd ready{client_.get(), POLLIN, 0};
        EXPECT_EQ(poll(&ready, 1, kPatience_ms), 1);
        std::array<std::uint8_t, 1000> bytes;
        sockaddr_in from{};
        socklen_t size = sizeof from;
        recvfrom(client_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT, reinterpret_cast<sockaddr*>(&from),
                 &size);
        return ntohl(from.sin_addr.s_addr);
    };
    EXPECT_EQ(sent_from(), kHere);
    EXPECT_THROW(sender_.open(kNobodys), DeviceError);
    EXPECT_EQ(sent_from(), kHere);
    sender_.open(kThere);
    EXPECT_EQ(sent_from(), kHere);
    sender_.close();
    sender_.start();
    EXPECT_EQ(sent_from(), kThere);
}

// 6 kB a frame at 200 kB/s, 30 ms: there is time enough in a frame for requests to keep it from its end.
TEST_P(Sender, FreshPacketsComeBeforeThoseAskedForAgain) {
    now_.state.throughput_limit_bytes_s = 200e3;
    ++now_.acquisition;
    sender_.set_stream(now_);
    constexpr std::uint64_t kFrames = 5;
    const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(kPatience_ms);
    for (std::uint64_t written = 0;
         sender_.counts().frames < kFrames && std::chrono::steady_clock::now() < until;) {
        if (written < kFrames && ring_.waiting() < GigeRing::kMaxWaiting) {
            ++record_.id;
            written += write().written;
            sender_.frame_ready();
        }
        for (std::uint64_t block = 1; block <= written; ++block)
            sender_.order({.to = now_.state.destination,
                           .acquisition = now_.acquisition,
                           .block = block,
                           .last = trailer(),
                           .extended_ids = now_.state.extended_ids,
                           .packet_bytes = now_.state.packet_bytes});
        take(0);
    }
    EXPECT_EQ(sender_.counts().frames, kFrames);
    EXPECT_EQ(sender_.counts().packets, kFrames * (trailer() + 1));
    EXPECT_LE(sender_.counts().packets_resent, GigeSender::kMaxResent * kFrames * (trailer() + 1));
}

TEST_P(Sender, ACountedAcquisitionTellsItsEnd) {
    now_.state.frames = 2;
    now_.acquisition = 7;
    sender_.set_stream(now_);
    send_frame();
    EXPECT_EQ(finished_, 0u);
    send_frame();
    for (int i = 0; i < kPatience_ms && finished_ == 0; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_EQ(finished_, 7u);
}

TEST_P(Sender, AGroupIsHeardByAllItsListeners) {
    std::array<Fd, 2> listeners;
    // 239.192.22.1; a port for each process, as tests run side by side.
    const auto port = static_cast<std::uint16_t>(20000 + getpid() % 20000);
    const sockaddr_in group = socket_address(0xEFC01601, port);
    for (Fd& listener : listeners) {
        listener = open_udp(0xEFC01601, port, true);
        const ip_mreq wanted{group.sin_addr, {htonl(kHere)}};
        if (setsockopt(listener.get(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &wanted, sizeof wanted) != 0)
            GTEST_SKIP() << "groups cannot be joined on the loopback interface";
    }
    now_.state.destination = {0xEFC01601, port};
    ++now_.acquisition;
    sender_.set_stream(now_);
    send_frame();
    for (const Fd& listener : listeners) {
        std::size_t count = 0;
        while (!receive(listener, 200).empty()) ++count;
        if (count == 0) GTEST_SKIP() << "the loopback interface does not carry groups";
        EXPECT_EQ(count, trailer() + 1);
    }
}

INSTANTIATE_TEST_SUITE_P(Ids, Sender, testing::Bool(),
                         [](const auto& p) { return p.param ? "Extended" : "Short"; });

INSTANTIATE_TEST_SUITE_P(Ids, LateFrames, testing::Values(true));

}  // namespace
}  // namespace hilcam
