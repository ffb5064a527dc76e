// Packets to a PTP port that follows a master: [u8 how][u16 length][packet] repeated. The byte: bits 0-1 what
// is done to the packet (as it is; its source made the master's; its type and source made the master's), bit
// 2 no arrival, bit 3 the last Delay_Req left, upper half: tenths of seconds that pass. Whatever comes, times
// and lengths stay in range, and what is sent is a Delay_Req.

#include <algorithm>
#include <array>
#include <vector>

#include "io/ptp/ptp_port.h"
#include "io/system/bytes.h"
#include "render/vocabulary/check.h"

namespace {

using namespace hilcam;

constexpr ptp::PortIdentity kMaster{0x001122FFFE334455, 1}, kOwn{0x020000FFFE000001, 1};

void give_master(PtpPort& port, std::int64_t now_ns) {
    ptp::Message announce;
    announce.type = ptp::MessageType::kAnnounce;
    announce.source = kMaster;
    announce.announce.grandmaster = kMaster.clock;
    announce.announce.priority1 = 0;
    announce.log_interval = 4;
    std::array<std::uint8_t, ptp::kMaxMessageBytes> bytes{};
    const std::size_t size = ptp::write_message(announce, bytes);
    port.receive(std::span(bytes).first(size), {}, now_ns);
}

// Makes a packet one that the port listens to.
void direct(std::vector<std::uint8_t>& packet, unsigned how) {
    if (packet.size() < 34 || how == 0) return;
    ByteWriter(std::span(packet).subspan(20)).u64(kMaster.clock).u16(kMaster.port);
    if (how == 1) return;
    constexpr std::uint8_t kTypes[] = {0x0, 0x8, 0x9, 0xB};
    packet[0] = kTypes[packet[0] % 4];
    packet[1] = 2;
    ByteWriter(std::span(packet).subspan(2)).u16(packet.size() & 0xFFFF).u8(0);
    if (packet.size() >= 54 && packet[0] == 9)
        ByteWriter(std::span(packet).subspan(44)).u64(kOwn.clock).u16(kOwn.port);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    DeviceClock clock({.rate = 50e-6}, {1'000'000'000, 0, 0});
    PtpPort port({kOwn, 0}, clock, [](const PtpNote& note) { HILCAM_CHECK(!text_of(note).empty()); });
    std::int64_t now_ns = 2'000'000'000;
    port.initialize();
    port.listen(now_ns);
    give_master(port, now_ns);
    give_master(port, now_ns);
    std::array<std::uint8_t, ptp::kMaxMessageBytes> out{};
    std::span<const std::uint8_t> rest(data, size);
    while (rest.size() >= 3) {
        const unsigned how = rest[0];
        now_ns += 1'000'000 + std::int64_t{how >> 4} * 100'000'000;
        const std::size_t length = std::min<std::size_t>(ByteReader(rest.subspan(1)).u16(), rest.size() - 3);
        std::vector<std::uint8_t> packet(rest.begin() + 3,
                                         rest.begin() + 3 + static_cast<std::ptrdiff_t>(length));
        direct(packet, how & 3);
        std::optional<std::int64_t> arrival_ns;
        if (!(how & 4)) arrival_ns = now_ns - 10'000;
        port.receive(packet, arrival_ns, now_ns);
        const std::size_t sent = port.tick(now_ns, out);
        if (sent > 0) {
            const auto request = ptp::read_message(std::span(out).first(sent));
            HILCAM_CHECK(request && request->type == ptp::MessageType::kDelayReq && request->source == kOwn);
        }
        if (how & 8) port.sent(now_ns + 20'000);
        const double rate = clock.line().rate;
        HILCAM_CHECK(rate > -2e-3 && rate < 2e-3);
        const PtpDataSet d = port.data_set();
        HILCAM_CHECK(d.state >= PtpState::kListening && d.state <= PtpState::kSlave && name_of(d.scale));
        rest = rest.subspan(3 + length);
    }
    return 0;
}
