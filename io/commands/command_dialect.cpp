#include "io/commands/command_dialect.h"

#include <array>

#include "io/commands/cfs_codec.h"
#include "io/commands/command_payload.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr std::uint16_t kTelecommand = 0x1800, kTelemetry = 0x0800;  // packets with a secondary header
constexpr std::array<std::uint16_t, 1> kCommandKinds = {kTelecommand | kCommandApid};
constexpr std::array<std::uint16_t, 3> kAnswerKinds = {
    kTelemetry | kAcknowledgeApid, kTelemetry | kFrameReportApid, kTelemetry | kHousekeepingApid};

bool has_crc(std::span<const std::uint8_t> packet) { return crc16(packet) == 0; }
// Eight bits of checksum are few, and may be ignored: the payload must also have the length of its function.
bool has_cfs_shape(std::span<const std::uint8_t> packet) {
    const std::optional<std::size_t> payload = payload_bytes(packet[6] & 0x7F);
    return payload && packet.size() == 8 + *payload;
}
bool has_cfs_checksum(std::span<const std::uint8_t> packet) {
    return has_cfs_shape(packet) && cfs_checksum(packet) == 0;
}
bool is_cfs_answer(std::span<const std::uint8_t> packet) {
    Acknowledgement acknowledgement;
    Telemetry telemetry;
    return decode_cfs_acknowledgement(packet, acknowledgement) || decode_cfs_telemetry(packet, telemetry);
}
bool is_cfs(const DialectConfig& dialect) { return dialect.dialect == Dialect::kCfs; }

}  // namespace

void add_fields(DialectConfig& d, Fields& fields) {
    fields.push_back(
        choice("dialect", d.dialect, {"hilcam", "cfs"},
               "packet headers: hilcam's own, or those of NASA's cFS (function code, checksum)"));
    fields.push_back(choice("checksum", d.checksum, {"required", "optional"},
                            "dialect cfs. required: a command with a wrong checksum byte is refused"));
}

void validate(const DialectConfig& d) {
    if (d.dialect == Dialect::kHilcam && d.checksum == ChecksumRule::kOptional)
        throw InputError("'checksum: optional' is for 'dialect: cfs'; hilcam's own packets end in a CRC");
}

DecodedCommand decode_command(std::span<const std::uint8_t> packet, const DialectConfig& d) {
    return is_cfs(d) ? decode_cfs_command(packet, d.checksum == ChecksumRule::kRequired)
                     : decode_command(packet);
}
std::size_t encode_command(const Command& command, std::uint32_t sequence, const DialectConfig& d,
                           std::span<std::uint8_t> bytes, std::uint16_t camera) {
    return is_cfs(d) ? encode_cfs_command(command, sequence, bytes)
                     : encode_command(command, sequence, bytes, camera);
}
std::size_t encode_acknowledgement(const Acknowledgement& a, std::uint16_t count, const DialectConfig& d,
                                   std::span<std::uint8_t> bytes) {
    return is_cfs(d) ? encode_cfs_acknowledgement(a, count, bytes) : encode_acknowledgement(a, count, bytes);
}
bool decode_acknowledgement(std::span<const std::uint8_t> packet, const DialectConfig& d,
                            Acknowledgement& a) {
    return is_cfs(d) ? decode_cfs_acknowledgement(packet, a) : decode_acknowledgement(packet, a);
}
std::size_t encode_telemetry(const Telemetry& t, std::uint16_t count, const DialectConfig& d,
                             std::span<std::uint8_t> bytes) {
    return is_cfs(d) ? encode_cfs_telemetry(t, count, bytes) : encode_telemetry(t, count, bytes);
}
bool decode_telemetry(std::span<const std::uint8_t> packet, const DialectConfig& d, Telemetry& t) {
    return is_cfs(d) ? decode_cfs_telemetry(packet, t) : decode_telemetry(packet, t);
}

PacketRule command_rule(const DialectConfig& d) {
    if (!is_cfs(d)) return {kCommandKinds, 16, kMaxPacketBytes, has_crc};
    return {kCommandKinds, 8, kMaxPacketBytes,
            d.checksum == ChecksumRule::kRequired ? has_cfs_checksum : has_cfs_shape};
}
PacketRule answer_rule(const DialectConfig& d) {
    if (!is_cfs(d)) return {kAnswerKinds, 16, kMaxPacketBytes, has_crc};
    return {kAnswerKinds, 18, kMaxPacketBytes, is_cfs_answer};
}

int sequence_bits(const DialectConfig& d) { return is_cfs(d) ? 14 : 32; }

}  // namespace hilcam
