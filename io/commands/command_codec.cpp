#include "io/commands/command_codec.h"

#include "io/commands/command_payload.h"

namespace hilcam {
namespace {

constexpr std::size_t kSecondaryBytes = 8;

Refusal check_header(const SpacePacketHeader& h, std::size_t size) {
    if (h.total_bytes() != size) return {CommandStatus::kBadLength, "length field and packet differ"};
    if (h.version != 0 || !h.command || !h.secondary_header || h.sequence_flags != 3)
        return {CommandStatus::kBadHeader, "not an unsegmented telecommand with a secondary header"};
    if (h.apid != kCommandApid) return {CommandStatus::kUnknownApid, "APID is not 0x100"};
    return {};
}

Refusal read_packet(std::span<const std::uint8_t> packet, DecodedCommand& out) {
    if (packet.size() < SpacePacketHeader::kBytes + kSecondaryBytes + kCrcBytes)
        return {CommandStatus::kBadLength, "shorter than the shortest command"};
    out.header = read_packet_header(packet);
    ByteReader in(packet);
    in.skip(SpacePacketHeader::kBytes);
    const std::uint8_t version = in.u8();
    out.function = in.u8();
    out.camera = in.u16();
    out.sequence = in.u32();
    if (const Refusal r = check_header(out.header, packet.size()); r.status != CommandStatus::kAccepted)
        return r;
    if (crc16(packet) != 0) return {CommandStatus::kBadChecksum, "CRC-16 does not match"};
    if (version != kProtocolVersion) return {CommandStatus::kBadHeader, "protocol version is not 1"};
    out.is_intact = true;
    const std::optional<std::size_t> expected = payload_bytes(out.function);
    if (!expected) return {CommandStatus::kUnknownFunction, "function code is not 1 to 12"};
    if (in.left() != *expected + kCrcBytes)
        return {CommandStatus::kBadLength, "payload is not as long as its function's"};
    return read_payload(in, out.function, out.command);
}

}  // namespace

DecodedCommand decode_command(std::span<const std::uint8_t> packet) {
    DecodedCommand out;
    const Refusal refusal = read_packet(packet, out);
    out.status = refusal.status;
    out.reason = refusal.reason;
    return out;
}

std::size_t encode_command(const Command& command, std::uint32_t sequence, std::span<std::uint8_t> bytes,
                           std::uint16_t camera) {
    ByteWriter out(bytes.subspan(SpacePacketHeader::kBytes));
    out.u8(kProtocolVersion).u8(function_of(command)).u16(camera).u32(sequence);
    write_payload(command, out);
    return seal_packet(
        {.command = true, .apid = kCommandApid, .count = static_cast<std::uint16_t>(sequence & 0x3FFF)},
        out.size(), bytes);
}

}  // namespace hilcam
