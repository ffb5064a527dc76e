#include "io/commands/cfs_codec.h"

#include "io/commands/command_payload.h"

namespace hilcam {
namespace {

constexpr std::size_t kCommandHeaderBytes = 8, kChecksumAt = 7;
constexpr std::size_t kTelemetryHeaderBytes = 16;
// 1980-01-01T00:00:00 TAI as seconds since 1970-01-01T00:00:00 TAI: ten years of 365 days and two leap days.
constexpr std::int64_t kCfsEpoch_s = (10 * 365 + 2) * 86400;
constexpr std::int64_t kSecond_ns = 1'000'000'000;

void write_header(const SpacePacketHeader& start, std::size_t size, std::span<std::uint8_t> bytes) {
    SpacePacketHeader header = start;
    header.count &= 0x3FFF;
    header.data_length = static_cast<std::uint16_t>(size - SpacePacketHeader::kBytes - 1);
    write_packet_header(header, bytes);
}

// Times before the epoch, or beyond 2^32 s after it, wrap as cFE's counter does.
void write_time(TimeTai time, ByteWriter& out) {
    std::int64_t seconds = time.ns / kSecond_ns, rest_ns = time.ns % kSecond_ns;
    if (rest_ns < 0) seconds -= 1, rest_ns += kSecond_ns;
    out.u32(static_cast<std::uint32_t>(seconds - kCfsEpoch_s));
    out.u16(static_cast<std::uint64_t>(rest_ns * 65536 / kSecond_ns));
    out.u32(0);
}

template <class WriteBody>
std::size_t encode_answer(std::uint16_t apid, TimeTai time, std::uint16_t count,
                          std::span<std::uint8_t> bytes, const WriteBody& write_body) {
    ByteWriter time_out(bytes.subspan(SpacePacketHeader::kBytes));
    write_time(time, time_out);
    ByteWriter body(bytes.subspan(kTelemetryHeaderBytes));
    write_body(body);
    const std::size_t size = kTelemetryHeaderBytes + body.size();
    write_header({.apid = apid, .count = count}, size, bytes);
    return size;
}

// Returns the body of an answer with this APID; empty when it is none.
std::span<const std::uint8_t> body_of(std::span<const std::uint8_t> packet, std::uint16_t& apid) {
    if (packet.size() <= kTelemetryHeaderBytes) return {};
    const SpacePacketHeader header = read_packet_header(packet);
    if (header.version != 0 || header.command || !header.secondary_header ||
        header.total_bytes() != packet.size())
        return {};
    apid = header.apid;
    return packet.subspan(kTelemetryHeaderBytes);
}

Refusal read_packet(std::span<const std::uint8_t> packet, bool checksum_required, DecodedCommand& out) {
    if (packet.size() < kCommandHeaderBytes)
        return {CommandStatus::kBadLength, "shorter than the shortest command"};
    out.header = read_packet_header(packet);
    out.sequence = out.header.count;
    ByteReader in(packet);
    in.skip(SpacePacketHeader::kBytes);
    out.function = in.u8() & 0x7F;  // the first bit is reserved
    in.u8();
    const SpacePacketHeader& h = out.header;
    if (h.total_bytes() != packet.size())
        return {CommandStatus::kBadLength, "length field and packet differ"};
    if (h.version != 0 || !h.command || !h.secondary_header || h.sequence_flags != 3)
        return {CommandStatus::kBadHeader, "not an unsegmented telecommand with a secondary header"};
    if (h.apid != kCommandApid) return {CommandStatus::kUnknownApid, "APID is not 0x100"};
    if (checksum_required && cfs_checksum(packet) != 0)
        return {CommandStatus::kBadChecksum, "checksum does not match"};
    out.is_intact = true;
    const std::optional<std::size_t> expected = payload_bytes(out.function);
    if (!expected) return {CommandStatus::kUnknownFunction, "function code is not 1 to 12"};
    if (in.left() != *expected)
        return {CommandStatus::kBadLength, "payload is not as long as its function's"};
    return read_payload(in, out.function, out.command);
}

}  // namespace

std::uint8_t cfs_checksum(std::span<const std::uint8_t> packet) {
    unsigned sum = 0xFF;
    for (const std::uint8_t byte : packet) sum ^= byte;
    return static_cast<std::uint8_t>(sum);
}

DecodedCommand decode_cfs_command(std::span<const std::uint8_t> packet, bool checksum_required) {
    DecodedCommand out;
    const Refusal refusal = read_packet(packet, checksum_required, out);
    out.status = refusal.status;
    out.reason = refusal.reason;
    return out;
}

std::size_t encode_cfs_command(const Command& command, std::uint32_t sequence,
                               std::span<std::uint8_t> bytes) {
    ByteWriter out(bytes.subspan(SpacePacketHeader::kBytes));
    out.u8(function_of(command)).u8(0);
    write_payload(command, out);
    const std::size_t size = SpacePacketHeader::kBytes + out.size();
    const auto count = static_cast<std::uint16_t>(sequence & 0x3FFF);
    write_header({.command = true, .apid = kCommandApid, .count = count}, size, bytes);
    bytes[kChecksumAt] = cfs_checksum(bytes.first(size));
    return size;
}

std::size_t encode_cfs_acknowledgement(const Acknowledgement& a, std::uint16_t count,
                                       std::span<std::uint8_t> bytes) {
    return encode_answer(kAcknowledgeApid, a.simulated_time, count, bytes,
                         [&](ByteWriter& out) { write_acknowledgement_body(a, out); });
}
bool decode_cfs_acknowledgement(std::span<const std::uint8_t> packet, Acknowledgement& a) {
    std::uint16_t apid = 0;
    const auto body = body_of(packet, apid);
    return !body.empty() && apid == kAcknowledgeApid && read_acknowledgement_body(body, a);
}

std::size_t encode_cfs_telemetry(const Telemetry& telemetry, std::uint16_t count,
                                 std::span<std::uint8_t> bytes) {
    return encode_answer(apid_of(telemetry), time_of(telemetry), count, bytes,
                         [&](ByteWriter& out) { write_telemetry_body(telemetry, out); });
}
bool decode_cfs_telemetry(std::span<const std::uint8_t> packet, Telemetry& telemetry) {
    std::uint16_t apid = 0;
    const auto body = body_of(packet, apid);
    return !body.empty() && read_telemetry_body(body, telemetry) && apid == apid_of(telemetry);
}

}  // namespace hilcam
