// The stream over real sockets, received by a plain program of this test: no Aravis.

#include "io/sink_gige.h"

#include <gmock/gmock.h>
#include <poll.h>
#include <sys/socket.h>

#include <chrono>
#include <cstring>
#include <map>
#include <set>
#include <thread>

#include "io/bytes.h"
#include "io/gige_features.h"
#include "io/gige_frame_writer.h"
#include "io/gige_sender.h"
#include "io/gvcp.h"

namespace hilcam {
namespace {

constexpr int kWidth = 64, kHeight = 48;
constexpr int kPatience_ms = 5000;  // until a test gives up; nothing waits so long when all is well

// Not the addresses that programs use.
constexpr std::uint32_t kHere = 0x7F530101;  // 127.83.1.1

sockaddr_in own_address(const Fd& socket) {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &size);
    return address;
}
Endpoint endpoint_of(const Fd& socket) {
    const sockaddr_in a = own_address(socket);
    return {ntohl(a.sin_addr.s_addr), ntohs(a.sin_port)};
}
// Empty: nothing came.
std::vector<std::uint8_t> receive(const Fd& socket, int patience_ms) {
    pollfd watched{socket.get(), POLLIN, 0};
    if (poll(&watched, 1, patience_ms) <= 0) return {};
    std::vector<std::uint8_t> bytes(65536);
    const ssize_t got = recv(socket.get(), bytes.data(), bytes.size(), 0);
    bytes.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    return bytes;
}

struct Packet {
    unsigned status = 0, flags = 0, format = 0;
    std::uint64_t block = 0;
    std::uint32_t id = 0;
    std::vector<std::uint8_t> data;
};
Packet parse(const std::vector<std::uint8_t>& bytes) {
    ByteReader in(bytes);
    Packet p;
    p.status = in.u16();
    p.block = in.u16();
    p.format = in.u8();
    p.id = std::uint32_t{in.u8()} << 16;
    p.id |= in.u16();
    if (p.format & 0x80) {
        p.flags = static_cast<unsigned>(p.block);
        p.format &= 0x7F;
        p.block = in.u64();
        p.id = in.u32();
    }
    p.data.assign(in.rest().begin(), in.rest().end());
    return p;
}

// --- the sender
// ------------------------------------------------------------------------------------------------------

class Sender : public testing::TestWithParam<bool> {
  protected:
    FaultBoard faults_{3};
    GigeRing ring_{GigeRing::kLeastSlots, most_payload_bytes(kWidth, kHeight, "")};
    GigeFrameWriter writer_{ring_, faults_, "", kWidth};
    std::atomic<std::uint64_t> finished_{0};
    GigeSender sender_{ring_, faults_, nullptr, {}, [this](std::uint64_t a) { finished_ = a; }};
    Fd client_ = open_udp(kHere, 0);
    GigeStreamNow now_;
    DnImage image_{kWidth, kHeight};
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
        s.width = kWidth, s.height = kHeight;
        now_.acquisition = 1;
        record_.bits = 12;
        sender_.set_stream(now_);
        sender_.start();
    }
    void TearDown() override { sender_.close(); }

    std::uint32_t trailer() const { return trailer_id(now_.state); }
    // Publishes a frame and waits until the sender is through with it.
    void send_frame() {
        ++record_.id;
        for (std::uint16_t& dn : image_.all()) dn = static_cast<std::uint16_t>(record_.id);
        const std::uint64_t before = sender_.counts().frames;
        ASSERT_TRUE(writer_.write(image_, record_, now_).written);
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
        std::vector<std::uint8_t> out(std::size_t{2} * kWidth * kHeight);
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
    EXPECT_EQ(ask(30 - GigeRing::kLeastKept + 1, 1, 1).status, gvsp::kResent);
    EXPECT_EQ(ask(2, 1, 1).status, gvsp::kRemovedWithAllBefore);
    EXPECT_EQ(ask(31, 1, 1).status, gvsp::kNotYetAvailable);
    EXPECT_EQ(ask(30, trailer() + 1, trailer() + 5).status, gvsp::kUnavailable);
    take(100);
    faults_.order({.kind = FaultKind::kFrameDrop, .rate = 1});
    ++record_.id;
    EXPECT_FALSE(writer_.write(image_, record_, now_).written);
    faults_.clear_all();
    send_frame();
    EXPECT_EQ(ask(31, 1, 1).status, gvsp::kUnavailable);  // it never was
    faults_.order({.kind = FaultKind::kResendRefused, .rate = 1});
    EXPECT_EQ(ask(32, 1, 1).status, gvsp::kUnavailable);
    faults_.clear_all();
    EXPECT_EQ(ask(32, 1, 1).status, gvsp::kResent);
    EXPECT_GE(sender_.counts().packets_refused, 5u);
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
    EXPECT_EQ(sender_.counts().test_packets, 3u);
    faults_.order({.kind = FaultKind::kLinkDown, .rate = 1});
    EXPECT_EQ(test(4004), 0u);
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
    const sockaddr_in group = socket_address(0xEFC01601, 34567);  // 239.192.22.1
    for (Fd& listener : listeners) {
        listener = open_udp(0xEFC01601, 34567, true);
        const ip_mreq wanted{group.sin_addr, {htonl(kHere)}};
        if (setsockopt(listener.get(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &wanted, sizeof wanted) != 0)
            GTEST_SKIP() << "groups cannot be joined on the loopback interface";
    }
    now_.state.destination = {0xEFC01601, 34567};
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

// --- whole cameras
// ------------------------------------------------------------------------------------------------------

class PlainCamera : public CameraControl {
  public:
    CameraSettings settings() const override {
        CameraSettings s;
        s.exposure_s = 0.001;
        s.frame_rate_hz = 30;
        return s;
    }
    CameraLimits limits() const override {
        CameraLimits l;
        l.width = kWidth;
        l.height = kHeight;
        l.bits = 12;
        l.least_exposure_s = 1e-5, l.most_exposure_s = 1;
        l.most_gain_db = 24;
        l.least_frame_rate_hz = 0.1, l.most_frame_rate_hz = 200;
        return l;
    }
    bool change(const SettingsChange&) override { return true; }
    TriggerResult trigger(const TriggerOrder&) override { return TriggerResult::kTaken; }
};

// An application with a socket for commands and one for the stream.
class Client {
  public:
    explicit Client(std::uint32_t address) : stream_(open_udp(address, 0)), control_(open_udp(address, 0)) {}

    // The answer's payload; empty without one.
    std::vector<std::uint8_t> command(std::uint32_t camera, std::uint16_t code,
                                      const std::vector<std::uint8_t>& payload) {
        std::vector<std::uint8_t> bytes(8 + payload.size());
        ByteWriter(bytes).u8(0x42).u8(1).u16(code).u16(payload.size()).u16(++id_).copy(payload);
        const sockaddr_in to = socket_address(camera, gvcp::kPort);
        sendto(control_.get(), bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to),
               sizeof to);
        const auto answer = receive(control_, kPatience_ms);
        EXPECT_GE(answer.size(), 8u);
        if (answer.size() < 8) return {};
        EXPECT_EQ(ByteReader(answer).u16(), 0u);
        return {answer.begin() + 8, answer.end()};
    }
    void write(std::uint32_t camera, std::uint32_t address, std::uint32_t value) {
        std::vector<std::uint8_t> payload(8);
        ByteWriter(payload).u32(address).u32(value);
        command(camera, gvcp::kWriteRegister, payload);
    }
    void start(std::uint32_t camera) {
        write(camera, 0x0A00, 2);  // control
        write(camera, 0x0D18, endpoint_of(stream_).ip);
        write(camera, 0x0D00, endpoint_of(stream_).port);
        write(camera, feature_register::kAcquisitionStart, 1);
    }
    const Fd& stream() const { return stream_; }

  private:
    Fd stream_, control_;
    std::uint16_t id_ = 0;
};

TEST(GigeSink, TwoCamerasInOneProcess) {
    constexpr std::uint32_t kFirst = 0x7F530201, kSecond = 0x7F530202;
    PlainCamera camera;
    std::array<FaultBoard, 2> faults;
    std::vector<std::unique_ptr<GigeSink>> sinks;
    for (std::size_t i = 0; i < 2; ++i) {
        GigeConfig config;
        config.interface = format_ipv4(i == 0 ? kFirst : kSecond);
        config.serial = i == 0 ? "TWO-1" : "TWO-2";
        sinks.push_back(std::make_unique<GigeSink>(config, SinkContext{camera, faults[i]}));
        sinks.back()->start();
    }
    // Both answer a broadcast, each from its own address. (Others on this machine may answer as well.)
    const Fd asking = open_udp(0x7F530203, 0);
    const int on = 1;
    setsockopt(asking.get(), SOL_SOCKET, SO_BROADCAST, &on, sizeof on);
    for (const std::uint32_t everybody : {0xFFFFFFFFu, 0x7FFFFFFFu}) {
        const std::array<std::uint8_t, 8> discovery = {0x42, 0x01, 0, 2, 0, 0, 0xFF, 0xFF};
        const sockaddr_in to = socket_address(everybody, gvcp::kPort);
        ASSERT_EQ(sendto(asking.get(), discovery.data(), discovery.size(), 0,
                         reinterpret_cast<const sockaddr*>(&to), sizeof to),
                  8)
            << std::strerror(errno);
        std::map<std::string, std::uint32_t> found;
        for (auto bytes = receive(asking, 1000); !bytes.empty() && found.size() < 2;
             bytes = receive(asking, 1000)) {
            ASSERT_EQ(bytes.size(), 256u);
            const std::string serial(reinterpret_cast<const char*>(bytes.data()) + 8 + 0xD8);
            if (serial.starts_with("TWO-"))
                found[serial] = ByteReader(std::span<const std::uint8_t>(bytes).subspan(8 + 0x24)).u32();
        }
        EXPECT_EQ(found, (std::map<std::string, std::uint32_t>{{"TWO-1", kFirst}, {"TWO-2", kSecond}}));
    }
    // One streams and the other does not; then both do, with numbers of their own.
    Client client(0x7F530203);
    DnImage image(kWidth, kHeight);
    FrameRecord record;
    record.bits = 12;
    const auto publish = [&] {
        ++record.id;
        for (const auto& sink : sinks) sink->publish(image, record);
    };
    const auto leaders = [&] {
        std::multiset<std::uint64_t> blocks;
        for (auto bytes = receive(client.stream(), 300); !bytes.empty();
             bytes = receive(client.stream(), 300))
            if (const Packet p = parse(bytes); p.format == gvsp::kLeader) blocks.insert(p.block);
        return blocks;
    };
    client.start(kFirst);
    publish();
    EXPECT_EQ(leaders(), (std::multiset<std::uint64_t>{1}));
    client.start(kSecond);
    publish();
    EXPECT_EQ(leaders(), (std::multiset<std::uint64_t>{1, 2}));
    // A cut cable: neither control nor stream, of one of them.
    faults[0].order({.kind = FaultKind::kLinkDown, .rate = 1});
    publish();
    EXPECT_EQ(leaders(), (std::multiset<std::uint64_t>{2}));
    faults[0].clear_all();
    publish();
    EXPECT_EQ(leaders(), (std::multiset<std::uint64_t>{3, 4}));
    for (const auto& sink : sinks) sink->stop();
    EXPECT_EQ(sinks[1]->report().frames, 3u);
    EXPECT_EQ(sinks[0]->report().name, "gige 127.83.2.1");
}

TEST(GigeSink, ATakenAddressIsSaid) {
    PlainCamera camera;
    FaultBoard faults;
    GigeConfig config;
    config.interface = "127.83.3.1";
    GigeSink first(config, {camera, faults}), second(config, {camera, faults});
    first.start();
    EXPECT_THROW(second.start(), DeviceError);
    first.stop();
    second.start();
}

}  // namespace
}  // namespace hilcam
