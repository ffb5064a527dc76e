// Whole cameras over real sockets, with a plain program of this test as their client.

#include "io/gige/sink_gige.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <map>
#include <set>
#include <thread>

#include "io/contract/fault.h"
#include "io/gige/device/gige_features.h"
#include "io/gige/device/gige_messages.h"
#include "io/gige/device/gvcp.h"
#include "io/gige/stream/gvsp.h"
#include "tests/support/gvsp_receiver.h"

namespace hilcam {
namespace {

constexpr int kWidth = 64, kHeight = 48;

class StreamedCamera : public CameraControl {
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
        l.min_exposure_s = 1e-5, l.max_exposure_s = 1;
        l.max_gain_db = 24;
        l.min_frame_rate_hz = 0.1, l.max_frame_rate_hz = 200;
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
    StreamedCamera camera;
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

// 127.64.0.0/10, of this process alone: the tests of a fixture run beside one another, and a camera's port is
// always the same.
std::uint32_t streams_loopback(std::uint32_t host) {
    const auto process = static_cast<std::uint32_t>(getpid());
    return 0x7F400000u | (process & 0x3FFFu) << 8 | host;
}

// 6 kB a frame at 200 kB/s, 30 ms: the ring is full at once.
struct SlowSink : testing::Test {
    const std::uint32_t camera_address = streams_loopback(1);
    StreamedCamera camera;
    FaultBoard faults;
    GigeSink sink{{.interface = format_ipv4(camera_address), .packet_bytes = 576, .rate_bytes_s = 200e3},
                  {camera, faults}};
    Client client{streams_loopback(2)};
    DnImage image{kWidth, kHeight};
    FrameRecord record;

    SlowSink() {
        record.bits = 12;
        sink.start();
    }
    void publish() {
        ++record.id;
        sink.publish(image, record);
    }
    bool wait_for_room() {
        for (int i = 0; i < kPatience_ms && !sink.has_room(); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return sink.has_room();
    }
};

TEST_F(SlowSink, WhoWaitsForRoomLosesNoFrame) {
    client.start(camera_address);
    int waits = 0;
    constexpr std::uint64_t kFrames = 10;  // that the client's buffer holds unread
    for (std::uint64_t i = 0; i < kFrames; ++i) {
        waits += !sink.has_room();
        ASSERT_TRUE(wait_for_room());
        publish();
    }
    EXPECT_GT(waits, 0);
    std::set<std::uint64_t> ended;  // the client's blocks that have a trailer
    while (ended.size() < kFrames) {
        const auto bytes = receive(client.stream(), kPatience_ms);
        ASSERT_FALSE(bytes.empty()) << ended.size();
        if (const Packet p = parse(bytes); p.format == gvsp::kTrailer) ended.insert(p.block);
    }
    EXPECT_EQ(sink.report().dropped, 0u);
    // Who does not wait loses some, and was told so.
    bool room = true;
    for (int i = 0; i < 10; ++i) {
        room = room && sink.has_room();
        publish();
    }
    EXPECT_FALSE(room);
    EXPECT_GT(sink.report().dropped, 0u);
}

TEST_F(SlowSink, FramesThatNobodyTakesAreNotWaitedFor) {
    const auto always_room = [&] {
        bool room = true;
        for (int i = 0; i < 10; ++i, publish()) room = room && sink.has_room();
        return room;
    };
    EXPECT_TRUE(always_room());  // no client
    client.start(camera_address);
    EXPECT_FALSE(always_room());
    client.write(camera_address, feature_register::kAcquisitionStop, 1);
    EXPECT_TRUE(always_room());
    client.write(camera_address, feature_register::kAcquisitionStart, 1);
    EXPECT_TRUE(wait_for_room());  // what waited was for nobody
    EXPECT_FALSE(always_room());
    client.write(camera_address, 0x0D00, 0);  // the stream's port
    EXPECT_TRUE(always_room());
}

// Its buffer fills and is never read.
TEST_F(SlowSink, AClientThatDoesNotTakeHoldsNobodyUp) {
    const int least = 1;
    setsockopt(client.stream().get(), SOL_SOCKET, SO_RCVBUF, &least, sizeof least);
    client.start(camera_address);
    for (int i = 0; i < 10; ++i, publish()) ASSERT_TRUE(wait_for_room()) << i;
    EXPECT_EQ(sink.report().dropped, 0u);
}

TEST_F(SlowSink, NeitherDoesACutCableNorAStoppedOutput) {
    client.start(camera_address);
    faults.order({.kind = FaultKind::kLinkDown, .rate = 1});
    for (int i = 0; i < 10; ++i, publish()) ASSERT_TRUE(wait_for_room()) << i;
    sink.stop();
    for (int i = 0; i < 10; ++i, publish()) EXPECT_TRUE(sink.has_room());
}

TEST(GigeSink, AnExposuresEndNamesItsFramesBlock) {
    constexpr std::uint32_t kCamera = 0x7F530601, kHere = 0x7F530602;
    StreamedCamera camera;
    FaultBoard faults;
    GigeSink sink({.interface = format_ipv4(kCamera)}, {camera, faults});
    sink.start();
    Client client(kHere);
    const Fd messages = open_udp(kHere, 0);
    client.write(kCamera, 0x0A00, 2);  // control
    client.write(kCamera, 0x0B10, kHere);
    client.write(kCamera, 0x0B00, endpoint_of(messages).port);
    for (const std::uint32_t exposure_event : {0u, 1u}) {
        client.write(kCamera, feature_register::kEventSelector, exposure_event);
        client.write(kCamera, feature_register::kEventNotification, 1);
    }
    struct Event {
        unsigned id = 0, channel = 0, block = 0;
        std::uint64_t frame = 0;
        bool operator==(const Event&) const = default;
    };
    const auto next_event = [&] {
        const auto bytes = receive(messages, kPatience_ms);
        ByteReader in(bytes);
        in.u64(), in.u16();  // header, reserved
        Event e;
        e.id = in.u16(), e.channel = in.u16(), e.block = in.u16();
        in.u64();  // time
        e.frame = in.u64();
        return e;
    };
    DnImage image(kWidth, kHeight);
    FrameRecord record;
    record.bits = 12;
    constexpr unsigned kStart = kGigeEvents[0].id, kEnd = kGigeEvents[1].id, kNone = 0xFFFF;
    const auto expose = [&](std::uint64_t frame, unsigned block) {
        record.id = frame;
        sink.on_event({CameraEvent::Kind::kExposureStart, frame + 1, 1000});  // the loop is a frame ahead
        sink.on_event({CameraEvent::Kind::kExposureEnd, frame, 2000});
        sink.publish(image, record);
        EXPECT_EQ(next_event(), (Event{kStart, kNone, 0, frame + 1}));
        EXPECT_EQ(next_event(), (Event{kEnd, block == 0 ? kNone : 0, block, frame}));
        if (block != 0) {
            EXPECT_EQ(parse(receive(client.stream(), kPatience_ms)).block, block);
        }
        while (!receive(client.stream(), 50).empty()) continue;
    };
    expose(7, 0);  // to nobody
    client.start(kCamera);
    expose(8, 0);  // its exposure had begun before
    expose(9, 1);
    faults.order({.kind = FaultKind::kFrameDrop, .rate = 1, .from_frame = 10, .frames = 1});
    sink.publish(image, (record.id = 10, record));
    expose(11, 3);
    sink.stop();
}

TEST(GigeSink, ATakenAddressIsSaid) {
    StreamedCamera camera;
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
