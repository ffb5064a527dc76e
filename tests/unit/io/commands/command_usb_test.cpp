// What of the USB transports needs no USB. The rest runs in a virtual machine: tests/devices/usb_commands.sh.

#include <gmock/gmock.h>

#include "io/commands/functionfs_descriptors.h"
#include "io/commands/usb_answers.h"
#include "io/commands/usb_device.h"
#include "render/vocabulary/check.h"
#include "tests/support/commands.h"

namespace hilcam {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Pipe {
    FaultBoard faults;
    UsbAnswers answers{faults, 4096};
    Bytes transfer() {
        Bytes bytes(16384);
        bytes.resize(answers.next(bytes));
        return bytes;
    }
};

TEST(UsbAnswers, TransfersNeverEndOnAPacketBoundary) {
    Pipe pipe;
    Bytes sent, got;
    for (std::size_t size = 1; size <= 70; ++size) {
        const Bytes packet(size, static_cast<std::uint8_t>(size));
        ASSERT_TRUE(pipe.answers.put(packet, false));
        sent.insert(sent.end(), packet.begin(), packet.end());
        if (size % 7 != 0 && size != 64) continue;
        for (Bytes t = pipe.transfer(); !t.empty(); t = pipe.transfer()) {
            EXPECT_NE(t.size() % 64, 0u);
            got.insert(got.end(), t.begin(), t.end());
        }
    }
    EXPECT_EQ(got, sent);
}

TEST(UsbAnswers, AFullQueueDropsTelemetryFirst) {
    Pipe pipe;
    const Bytes packet(100);
    int telemetry = 0, answers = 0;
    while (pipe.answers.put(packet, true)) ++telemetry;
    while (pipe.answers.put(packet, false)) ++answers;
    EXPECT_EQ(telemetry, 20);  // of 2048 bytes
    EXPECT_EQ(answers, 20);    // of the rest
    pipe.answers.clear();
    EXPECT_TRUE(pipe.answers.put(packet, true));
}

TEST(UsbAnswers, FaultsDoWhatTheySay) {
    Pipe pipe;
    const Bytes packet = encoded(StartCommand{}, 1);
    pipe.faults.order({FaultKind::kUsbBadCrc});
    pipe.answers.put(packet, false);
    Bytes got = pipe.transfer();
    EXPECT_EQ(got.size(), packet.size());
    EXPECT_NE(crc16(got), 0);
    pipe.faults.clear_all();

    pipe.faults.order({FaultKind::kUsbShortTransfer});
    pipe.answers.put(packet, false);
    got = pipe.transfer();
    EXPECT_EQ(got.size(), packet.size() / 2);
    const Bytes rest = pipe.transfer();
    got.insert(got.end(), rest.begin(), rest.end());
    EXPECT_EQ(got, packet);
    pipe.faults.clear_all();

    pipe.faults.order({FaultKind::kUsbStall});
    pipe.answers.put(packet, false);
    EXPECT_TRUE(pipe.transfer().empty());
    EXPECT_TRUE(pipe.transfer().empty());
    EXPECT_EQ(pipe.faults.strikes_of(FaultKind::kUsbStall), 1u);
    pipe.faults.clear_all();
    EXPECT_EQ(pipe.transfer(), packet);
}

TEST(UsbId, IsReadAsLsusbPrintsIt) {
    const UsbId id = parse_usb_id("1209:00aF:bench:7");
    EXPECT_EQ(id.vendor, 0x1209);
    EXPECT_EQ(id.product, 0xAF);
    EXPECT_EQ(id.serial, "bench:7");
    EXPECT_EQ(to_string(id), "1209:00af:bench:7");
    EXPECT_TRUE(parse_usb_id("1209:1").serial.empty());
    for (const char* bad : {"", "1209", "1209:", ":1", "12090:1", "1209:1:", "1209:1x", "0x1209:1"})
        EXPECT_THROW(parse_usb_id(bad), InputError) << bad;
}

std::uint32_t u32(const Bytes& bytes, std::size_t at) {
    return bytes[at] | bytes[at + 1] << 8 | bytes[at + 2] << 16 |
           static_cast<std::uint32_t>(bytes[at + 3]) << 24;
}

// Against the kernel's own reading of them: lengths that add up, endpoints of the three speeds.
TEST(FunctionFs, DescriptorsAreWellFormed) {
    const Bytes d = functionfs_descriptors();
    EXPECT_EQ(u32(d, 0), 3u);  // FUNCTIONFS_DESCRIPTORS_MAGIC_V2
    EXPECT_EQ(u32(d, 4), d.size());
    std::size_t at = 12 + 3 * 4;
    std::vector<unsigned> packet_sizes;
    unsigned count = 0;
    for (; at < d.size(); at += d[at], ++count) {
        ASSERT_GT(d[at], 2u);
        if (d[at + 1] == 5) packet_sizes.push_back(d[at + 4] | d[at + 5] << 8u);
    }
    EXPECT_EQ(at, d.size());
    EXPECT_EQ(count, u32(d, 12) + u32(d, 16) + u32(d, 20));
    EXPECT_THAT(packet_sizes, testing::ElementsAre(64, 64, 512, 512, 1024, 1024));
    const Bytes s = functionfs_strings("x");
    EXPECT_EQ(u32(s, 0), 2u);  // FUNCTIONFS_STRINGS_MAGIC
    EXPECT_EQ(u32(s, 4), s.size());
    EXPECT_EQ(s.size(), 20u);
}

}  // namespace
}  // namespace hilcam
