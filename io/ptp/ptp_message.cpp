#include "io/ptp/ptp_message.h"

#include <cstdlib>

#include "io/system/bytes.h"

namespace hilcam::ptp {
namespace {

constexpr std::uint8_t kPtpVersion = 2;
constexpr std::size_t kPtpHeaderBytes = 34;

// Whole length of a message of this type; 0: not read here.
std::size_t length_of(MessageType type) {
    switch (type) {
        case MessageType::kSync:
        case MessageType::kDelayReq:
        case MessageType::kFollowUp:
            return 44;
        case MessageType::kDelayResp:
            return 54;
        case MessageType::kAnnounce:
            return 64;
    }
    return 0;
}

// Sync 0, Delay_Req 1, Follow_Up 2, Delay_Resp 3, others 5 (table 23).
std::uint8_t control_of(MessageType type) {
    switch (type) {
        case MessageType::kSync:
            return 0;
        case MessageType::kDelayReq:
            return 1;
        case MessageType::kFollowUp:
            return 2;
        case MessageType::kDelayResp:
            return 3;
        case MessageType::kAnnounce:
            break;
    }
    return 5;
}

// Seconds of 48 bits, nanoseconds of 32 (5.3.3). Returns false when it is out of range.
bool read_time(ByteReader& in, std::int64_t& ns) {
    const std::uint64_t upper = in.u16(), seconds = upper << 32 | in.u32();
    const std::uint32_t nanoseconds = in.u32();
    if (seconds > static_cast<std::uint64_t>(kMaxTime_s) || nanoseconds >= 1'000'000'000) return false;
    ns = static_cast<std::int64_t>(seconds) * 1'000'000'000 + nanoseconds;
    return true;
}
void write_time(ByteWriter& out, std::int64_t ns) {
    const auto seconds = static_cast<std::uint64_t>(ns / 1'000'000'000);
    out.u16(seconds >> 32 & 0xFFFF).u32(seconds & 0xFFFFFFFF);
    out.u32(static_cast<std::uint64_t>(ns % 1'000'000'000));
}

PortIdentity read_identity(ByteReader& in) {
    PortIdentity id;
    id.clock = in.u64();
    id.port = in.u16();
    return id;
}

Announce read_announce(ByteReader& in) {
    Announce a;
    in.skip(10);  // originTimestamp: 0 or an estimate
    a.utc_offset_s = static_cast<std::int16_t>(in.u16());
    in.skip(1);
    a.priority1 = in.u8();
    a.clock_class = in.u8();
    a.accuracy = in.u8();
    a.variance = in.u16();
    a.priority2 = in.u8();
    a.grandmaster = in.u64();
    a.steps_removed = in.u16();
    a.time_source = in.u8();
    return a;
}

}  // namespace

std::optional<Message> read_message(std::span<const std::uint8_t> bytes) {
    if (bytes.size() < kPtpHeaderBytes) return {};
    ByteReader in(bytes);
    Message m;
    const std::uint8_t first = in.u8();
    m.type = static_cast<MessageType>(first & 0xF);
    const std::size_t needed = length_of(m.type);
    // The upper half is transportSpecific; 1 is IEEE 802.1AS, which has other rules.
    if (first >> 4 != 0 || needed == 0) return {};
    if ((in.u8() & 0xF) != kPtpVersion) return {};
    const std::size_t length = in.u16();
    if (length < needed || length > bytes.size()) return {};
    m.domain = in.u8();
    in.skip(1);
    m.flags = in.u16();
    m.correction_scaled_ns = in.i64();
    if (m.correction_scaled_ns / 65536 > kMaxCorrection_ns ||
        m.correction_scaled_ns / 65536 < -kMaxCorrection_ns)
        return {};
    in.skip(4);
    m.source = read_identity(in);
    m.sequence = in.u16();
    in.skip(1);  // controlField says again what the type says
    m.log_interval = static_cast<std::int8_t>(in.u8());
    if (m.type == MessageType::kAnnounce)
        m.announce = read_announce(in);
    else if (!read_time(in, m.time_ns))
        return {};
    if (m.type == MessageType::kDelayResp) m.requester = read_identity(in);
    return m;
}

std::size_t write_message(const Message& m, std::span<std::uint8_t> out) {
    const std::size_t length = length_of(m.type);
    ByteWriter w(out.first(length));
    w.u8(static_cast<std::uint8_t>(m.type)).u8(kPtpVersion).u16(length).u8(m.domain).u8(0).u16(m.flags);
    w.u64(static_cast<std::uint64_t>(m.correction_scaled_ns)).u32(0);
    w.u64(m.source.clock).u16(m.source.port).u16(m.sequence).u8(control_of(m.type));
    w.u8(static_cast<std::uint8_t>(m.log_interval));
    write_time(w, m.time_ns);
    if (m.type == MessageType::kDelayResp) w.u64(m.requester.clock).u16(m.requester.port);
    if (m.type == MessageType::kAnnounce) {
        const Announce& a = m.announce;
        w.u16(static_cast<std::uint16_t>(a.utc_offset_s)).u8(0).u8(a.priority1).u8(a.clock_class);
        w.u8(a.accuracy).u16(a.variance).u8(a.priority2).u64(a.grandmaster).u16(a.steps_removed);
        w.u8(a.time_source);
    }
    return length;
}

}  // namespace hilcam::ptp
