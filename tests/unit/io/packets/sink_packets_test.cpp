#include "io/packets/sink_packets.h"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "io/packets/packet_stream_peer.h"
#include "io/system/unix_socket_file.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::HasSubstr;
using Transport = PacketsConfig::Transport;

class PacketsSinkTest : public FilesTest {
  protected:
    PacketsConfig files(Transport transport = Transport::kFiles) const {
        PacketsConfig config;
        config.transport = transport;
        config.folder = folder_ / "out";
        return config;
    }
    void fill_up(const std::string& name) const {
        std::filesystem::create_symlink("/dev/full", folder_ / "out" / name);
    }
};

// Publishes frames and waits for room before each.
void publish(PacketsSink& sink, std::uint64_t first, std::uint64_t last, int width = 8, int height = 4) {
    for (std::uint64_t id = first; id <= last; ++id) {
        while (!sink.has_room()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        FrameRecord record;
        record.id = id, record.bits = 12;
        sink.publish(DnImage(width, height), record);
    }
}
void publish_at_once(PacketsSink& sink, std::uint64_t count) {
    for (std::uint64_t id = 1; id <= count; ++id) {
        FrameRecord record;
        record.id = id, record.bits = 12;
        sink.publish(DnImage(8, 4), record);
    }
}
std::string text_of(const std::vector<SinkNote>& notes) {
    std::string text;
    for (const SinkNote& note : notes) text += note.text + "\n";
    return text;
}
Fd connect_unix(const std::string& path) {
    Fd fd(::socket(AF_UNIX, SOCK_STREAM, 0));
    const sockaddr_un to = unix_address(path);
    EXPECT_EQ(connect(fd.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
    return fd;
}

// A frame of 8 x 4 pixels of two bytes in one packet: 6 + 64 + 64 + 2 bytes.
constexpr std::uintmax_t kPacketBytes = 136;

TEST_F(PacketsSinkTest, EachFrameHasItsFileOrAllHaveOne) {
    PacketsSink each(files(), 8, 4, {});
    each.start();
    publish(each, 1, 3);
    each.stop();
    EXPECT_EQ(each.report().frames, 3u);
    for (const char* name : {"frame_00000001.bin", "frame_00000003.bin"})
        EXPECT_EQ(std::filesystem::file_size(folder_ / "out" / name), kPacketBytes);
    PacketsConfig config = files(Transport::kFile);
    EXPECT_THROW(PacketsSink(config, 8, 4, {}), InputError) << "another run's files";
    config.overwrite = true;
    PacketsSink all(config, 8, 4, {});
    all.start();
    publish(all, 1, 3);
    all.stop();
    EXPECT_EQ(std::filesystem::file_size(folder_ / "out/packets.bin"), 3 * kPacketBytes);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out/frame_00000001.bin"));
}

TEST_F(PacketsSinkTest, AFullDiskIsToldByTheFirstFrameThatIsLostAndTheNextIsTried) {
    FrameFates fates;
    PacketsSink sink(files(), 8, 4, {}, true, {.fates = fates.claim()});
    EXPECT_EQ(fates.claim(), nullptr) << "files of one output alone";
    sink.start();
    fill_up("frame_00000002.bin");
    publish(sink, 1, 3);
    sink.stop();
    EXPECT_EQ(fates.of(1), FrameFates::Fate::kWritten);
    EXPECT_EQ(fates.of(2), FrameFates::Fate::kLost) << "a line of truth says so";
    const SinkReport report = sink.report();
    EXPECT_EQ(report.frames, 2u);
    EXPECT_EQ(report.dropped, 1u);
    EXPECT_EQ(report.first_dropped, 2u);
    EXPECT_TRUE(sink.has_fault());
    EXPECT_THAT(report.fault,
                HasSubstr("frame_00000002.bin cannot be written: No space left on device (1 frame lost)"));
    EXPECT_FALSE(std::filesystem::is_symlink(folder_ / "out/frame_00000002.bin"));
}

// With a limit on the file's size in place of a full disk: the kernel writes a part of a frame, then refuses.
TEST_F(PacketsSinkTest, TheOneFileEndsWithAWholeFrame) {
    PacketsSink sink(files(Transport::kFile), 8, 4, {});
    sink.start();
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const auto old = signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{2 * kPacketBytes + 50, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
    publish(sink, 1, 4);
    sink.stop();
    setrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, old);
    EXPECT_EQ(std::filesystem::file_size(folder_ / "out/packets.bin"), 2 * kPacketBytes);
    EXPECT_THAT(sink.report().fault,
                HasSubstr("packets.bin cannot be written: File too large (the first of 2 frames lost)"));
}

TEST_F(PacketsSinkTest, FramesThatComeTooFastAreAFaultUnlessTheyMayBeDropped) {
    for (const WhenSlow when_slow : {WhenSlow::kAuto, WhenSlow::kWait, WhenSlow::kDrop}) {
        PacketsConfig config = files();
        config.when_slow = when_slow, config.overwrite = true;
        PacketsSink sink(config, 8, 4, {});
        publish_at_once(sink, 10);  // before start() nothing takes frames out: eight wait
        sink.start();
        sink.stop();
        const SinkReport report = sink.report();
        EXPECT_EQ(report.frames, 8u);
        EXPECT_EQ(report.dropped, 2u);
        EXPECT_EQ(report.first_dropped, 9u);
        EXPECT_EQ(sink.has_fault(), when_slow != WhenSlow::kDrop);
        EXPECT_EQ(report.fault.empty(), when_slow == WhenSlow::kDrop);
        if (sink.has_fault()) {
            EXPECT_THAT(report.fault, HasSubstr("2 of 10 frames came too fast"));
        }
    }
}

TEST_F(PacketsSinkTest, FramesThatNobodyTakesAreUnwanted) {
    PacketsConfig config;
    config.transport = Transport::kUnixServer;
    config.path = folder_ / "socket";
    PacketsSink sink(config, 8, 4, {});
    sink.start();
    publish(sink, 1, 20);
    sink.stop();
    EXPECT_EQ(sink.report().unwanted, 20u);
    EXPECT_EQ(sink.report().dropped, 0u);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "socket"));
}

TEST_F(PacketsSinkTest, AClientThatReadsNothingIsGivenUpAndNamedOnce) {
    PacketsConfig config;
    config.transport = Transport::kUnixServer;
    config.path = folder_ / "socket";
    config.patience_s = 0.05;
    PacketsSink sink(config, 512, 512, {});
    sink.start();
    const Fd lazy = connect_unix(config.path.string());
    publish(sink, 1, 20, 512, 512);  // half a MiB each, more than the socket holds
    sink.stop();
    const SinkReport report = sink.report();
    EXPECT_EQ(report.frames, 0u);
    EXPECT_EQ(report.dropped, 1u);
    EXPECT_EQ(report.first_dropped, 1u);
    EXPECT_EQ(report.unwanted, 19u);
    EXPECT_FALSE(sink.has_fault());
    const std::string notes = text_of(sink.take_notes());
    EXPECT_THAT(notes, HasSubstr("a client is connected"));
    EXPECT_THAT(notes, HasSubstr("a client has read nothing for 50 ms and is disconnected"));
    EXPECT_EQ(std::count(notes.begin(), notes.end(), '\n'), 2);
}

TEST_F(PacketsSinkTest, AClientThatVanishesIsNamedAndTheNextIsServed) {
    PacketsConfig config;
    config.transport = Transport::kUnixServer;
    config.path = folder_ / "socket";
    PacketsSink sink(config, 8, 4, {});
    sink.start();
    {
        const Fd first = connect_unix(config.path.string());
        publish(sink, 1, 1);
        std::array<std::uint8_t, kPacketBytes> packet{};
        EXPECT_EQ(recv(first.get(), packet.data(), packet.size(), MSG_WAITALL),
                  static_cast<ssize_t>(kPacketBytes));
        EXPECT_EQ(packet[0], 0x09);
    }
    publish(sink, 2, 2);
    while (sink.report().dropped == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const Fd second = connect_unix(config.path.string());
    publish(sink, 3, 3);
    std::array<std::uint8_t, kPacketBytes> packet{};
    EXPECT_EQ(recv(second.get(), packet.data(), packet.size(), MSG_WAITALL),
              static_cast<ssize_t>(kPacketBytes));
    EXPECT_EQ(packet[6 + 39], 3) << "the frame";
    sink.stop();
    EXPECT_EQ(sink.report().frames, 2u);
    EXPECT_THAT(text_of(sink.take_notes()), HasSubstr("a client is gone (Broken pipe)"));
}

TEST_F(PacketsSinkTest, AReceiverMayComeLater) {
    PacketsConfig config;
    config.transport = Transport::kUnix;
    config.path = folder_ / "socket";
    PacketsSink sink(config, 8, 4, {});
    sink.start();
    publish(sink, 1, 5);
    while (sink.report().unwanted < 5) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    UnixSocketFile file;
    const Fd listener = file.listen(config.path.string(), SOCK_STREAM);
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    publish(sink, 6, 6);
    sink.stop();
    EXPECT_EQ(sink.report().frames, 1u);
    const std::string notes = text_of(sink.take_notes());
    EXPECT_THAT(notes,
                HasSubstr("nobody is there (No such file or directory); tried again each half second"));
    EXPECT_THAT(notes, HasSubstr("connected"));
    EXPECT_EQ(std::count(notes.begin(), notes.end(), '\n'), 2);
}

TEST_F(PacketsSinkTest, UdpWithoutAListenerIsNamedOnce) {
    PacketsConfig config;
    // The port of a socket that is closed again.
    {
        const Fd probe = open_udp(0x7F000001, 0);
        sockaddr_in at{};
        socklen_t size = sizeof at;
        getsockname(probe.get(), reinterpret_cast<sockaddr*>(&at), &size);
        config.port = ntohs(at.sin_port);
    }
    PacketsSink sink(config, 64, 64, {});
    sink.start();
    publish(sink, 1, 5, 64, 64);  // six packets each: the kernel answers all but the last in time
    sink.stop();
    EXPECT_GT(sink.report().unwanted, 0u);
    EXPECT_EQ(sink.report().dropped, 0u);
    const std::string notes = text_of(sink.take_notes());
    EXPECT_EQ(std::count(notes.begin(), notes.end(), '\n'), 1) << notes;
    EXPECT_THAT(notes, HasSubstr("nobody listens there"));
}

TEST_F(PacketsSinkTest, EveryNthFrameIsSent) {
    PacketsConfig config = files();
    config.every_nth = 3;
    PacketsSink sink(config, 8, 4, {});
    sink.start();
    publish(sink, 1, 7);
    sink.stop();
    EXPECT_EQ(sink.report().frames, 3u);
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out/frame_00000004.bin"));
}

TEST_F(PacketsSinkTest, TheReportSaysHowMuchACompressionGains) {
    PacketsConfig config = files();
    config.payload = Payload::kRawLittleEndian;
    PacketsSink sink(config, 8, 4, {});
    sink.start();
    publish(sink, 1, 2);
    sink.stop();
    const auto figures = sink.report().figures;
    const auto figure = [&](std::string_view name) {
        for (const auto& [key, value] : figures)
            if (key == name) return value;
        return -1.0;
    };
    EXPECT_DOUBLE_EQ(figure("payload_bytes_a_frame"), 64);
    EXPECT_DOUBLE_EQ(figure("compression_ratio"), 12.0 / 16);
    EXPECT_EQ(figure("packets_sent"), 2);
    EXPECT_EQ(figure("bytes_sent"), 2.0 * kPacketBytes);
    EXPECT_GT(figure("encoding_core_ms_a_frame"), 0);
}

TEST_F(PacketsSinkTest, AListeningSocketThatIsTakenOrIsNoSocketIsNamed) {
    const std::string path = (folder_ / "socket").string();
    UnixSocketFile first, second;
    Fd listener = first.listen(path, SOCK_STREAM);
    EXPECT_THROW(second.listen(path, SOCK_STREAM), DeviceError);
    listener.reset();
    first.remove();
    EXPECT_FALSE(std::filesystem::exists(path));
    std::ofstream(path) << "a file";
    EXPECT_THROW(second.listen(path, SOCK_STREAM), DeviceError);
    EXPECT_TRUE(std::filesystem::exists(path));
}

TEST(SendPacer, HoldsTheRateAndMakesUpForOneMillisecondAtMost) {
    SendPacer pacer(1e6);  // a byte a microsecond
    std::int64_t now = 5'000'000'000;
    for (int i = 0; i < 100; ++i) now = pacer.may_leave(now, 1000);
    // 99 packets of 1 ms after the first, less the burst.
    EXPECT_EQ(now, 5'000'000'000 + 98'000'000);
    now += 50'000'000;  // unused
    const std::int64_t begun = now;
    for (int i = 0; i < 10; ++i) now = pacer.may_leave(now, 1000);
    EXPECT_EQ(now - begun, 8'000'000);
}

std::string refusal(const PacketsConfig& config) {
    try {
        validate(config);
    } catch (const InputError& error) {
        return error.what();
    }
    return "none";
}

TEST(PacketsConfig, WhatCannotBeSentIsRefusedInOneLine) {
    PacketsConfig config;
    EXPECT_EQ(refusal(config), "none");
    config.packet_bytes = 65508;
    EXPECT_EQ(refusal(config), "packet_bytes: found 65508; accepted: 65507 at most in a UDP datagram");
    config.transport = Transport::kTcp;
    EXPECT_EQ(refusal(config), "none");
    config.transport = Transport::kUdp, config.packet_bytes = 65500, config.has_spacewire = true;
    EXPECT_EQ(refusal(config), "none");
    config.spacewire.path_address = {1, 2, 3, 4};
    EXPECT_EQ(refusal(config), "packet_bytes: found 65500; accepted: 65499 at most in a UDP datagram");
    config = {};
    config.address = "example.org";
    EXPECT_EQ(refusal(config), "address: found 'example.org'; accepted: an IPv4 address, as 192.168.1.5");
    config = {};
    config.transport = Transport::kUnix;
    EXPECT_EQ(refusal(config),
              "path: found none; accepted: the path of a Unix socket or, with usb, of FunctionFS");
    config.path = std::string(200, 'x');
    EXPECT_THAT(refusal(config), HasSubstr("1 to 107 bytes long"));
    config = {};
    config.transport = Transport::kTcpServer, config.address = "0.0.0.0";
    EXPECT_THAT(refusal(config), HasSubstr("which others can reach; give 'outputs.packets.allow' too"));
    config = {};
    config.has_spacewire = true, config.packet_bytes = 1000;
    config.spacewire.protocol = SpaceWireConfig::Protocol::kRmap;
    config.spacewire.slots = 4, config.spacewire.slot_bytes = 512;
    EXPECT_EQ(refusal(config), "packet_bytes: found 1000; accepted: 512 at most, as spacewire.slot_bytes");
}

}  // namespace
}  // namespace hilcam
