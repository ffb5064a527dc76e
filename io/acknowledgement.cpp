#include "io/acknowledgement.h"

#include <algorithm>
#include <array>

#include "io/ccsds.h"

namespace hilcam {
namespace {

constexpr std::uint8_t kAcknowledgeBit = 0x80;
constexpr std::size_t kMostReasonBytes = 96;

}  // namespace

void write_acknowledgement_body(const Acknowledgement& a, ByteWriter& out) {
    const std::size_t reason_bytes = std::min(a.reason.size(), kMostReasonBytes);
    out.u8(kProtocolVersion).u8(a.function | kAcknowledgeBit);
    out.u8(static_cast<std::uint8_t>(a.status)).u8(0).u32(a.sequence).u64(a.token);
    out.u64(static_cast<std::uint64_t>(a.simulated_time.ns)).u16(reason_bytes);
    for (std::size_t i = 0; i < reason_bytes; ++i) out.u8(static_cast<std::uint8_t>(a.reason[i]));
}

bool read_acknowledgement_body(std::span<const std::uint8_t> body, Acknowledgement& a) {
    ByteReader in(body);
    if (in.u8() != kProtocolVersion) return false;
    a.function = in.u8() & static_cast<std::uint8_t>(~kAcknowledgeBit);
    a.status = static_cast<CommandStatus>(in.u8());
    in.u8();
    a.sequence = in.u32();
    a.token = in.u64();
    a.simulated_time.ns = in.i64();
    const std::size_t reason_bytes = in.u16();
    if (!in.ok() || in.left() != reason_bytes) return false;
    a.reason.assign(reinterpret_cast<const char*>(in.rest().data()), reason_bytes);
    return true;
}

std::size_t encode_acknowledgement(const Acknowledgement& a, std::uint16_t count,
                                   std::span<std::uint8_t> bytes) {
    ByteWriter out(bytes.subspan(SpacePacketHeader::kBytes));
    write_acknowledgement_body(a, out);
    return seal_packet({.command = false, .apid = kAcknowledgeApid, .count = count}, out.size(), bytes);
}

bool decode_acknowledgement(std::span<const std::uint8_t> packet, Acknowledgement& a) {
    if (packet.size() < SpacePacketHeader::kBytes + kCrcBytes || crc16(packet) != 0) return false;
    const SpacePacketHeader header = read_packet_header(packet);
    if (header.command || header.apid != kAcknowledgeApid || header.total_bytes() != packet.size())
        return false;
    const std::size_t body_bytes = packet.size() - SpacePacketHeader::kBytes - kCrcBytes;
    return read_acknowledgement_body(packet.subspan(SpacePacketHeader::kBytes, body_bytes), a);
}

std::string_view name_of(CommandStatus status) {
    // In the order of their numbers.
    constexpr std::array<std::string_view, 11> kNames = {
        "accepted",         "bad length",   "bad header",     "unknown APID",      "bad checksum",
        "unknown function", "bad argument", "unknown object", "time out of range", "busy",
        "not now"};
    const auto number = static_cast<std::size_t>(status);
    return number < kNames.size() ? kNames[number] : "unknown status";
}

}  // namespace hilcam
