#include "io/commands/telemetry_codec.h"

namespace hilcam {
namespace {

constexpr std::uint8_t kFrameReportKind = 1, kHousekeepingKind = 2;
constexpr std::size_t kFrameReportBytes = 80, kHousekeepingBytes = 108;  // bodies

std::uint64_t bits_of(std::int64_t value) { return static_cast<std::uint64_t>(value); }

void write(ByteWriter& out, const FrameReport& r) {
    out.u8(kProtocolVersion).u8(kFrameReportKind).u8(r.camera).u8(0);
    out.u64(r.frame).u64(bits_of(r.exposure_mid.ns)).u64(bits_of(r.exposure_mid_monotonic_ns));
    out.f64(r.exposure_s).f64(r.gain_db).u32(r.pose_sequence).u32(r.trigger_sequence);
    out.u64(bits_of(r.pose_time.ns)).u64(bits_of(r.latency_ns)).u64(r.faults).u32(r.quality_level);
}
void read(ByteReader& in, FrameReport& r) {
    r.camera = in.u8();
    in.u8();
    r.frame = in.u64();
    r.exposure_mid.ns = in.i64();
    r.exposure_mid_monotonic_ns = in.i64();
    r.exposure_s = in.f64();
    r.gain_db = in.f64();
    r.pose_sequence = in.u32();
    r.trigger_sequence = in.u32();
    r.pose_time.ns = in.i64();
    r.latency_ns = in.i64();
    r.faults = in.u64();
    r.quality_level = in.u32();
}

void write(ByteWriter& out, const HousekeepingFigures& h) {
    out.u8(kProtocolVersion).u8(kHousekeepingKind);
    out.u8(static_cast<std::uint8_t>(h.mode)).u8(h.running ? 1u : 0u);
    out.u64(bits_of(h.simulated_time.ns)).u64(bits_of(h.monotonic_ns)).f64(h.uptime_s);
    out.u64(h.frames).f64(h.frame_rate_hz).u64(h.deadline_misses);
    out.u64(h.commands_received).u64(h.commands_refused).u64(h.commands_lost);
    out.f64(h.latency_p50_s).f64(h.latency_p99_s).f64(h.temperature_c);
    out.u32(h.active_faults).u32(h.clients);
}
void read(ByteReader& in, HousekeepingFigures& h) {
    h.mode = static_cast<OperatingMode>(in.u8());
    h.running = in.u8() != 0;
    h.simulated_time.ns = in.i64();
    h.monotonic_ns = in.i64();
    h.uptime_s = in.f64();
    h.frames = in.u64();
    h.frame_rate_hz = in.f64();
    h.deadline_misses = in.u64();
    h.commands_received = in.u64();
    h.commands_refused = in.u64();
    h.commands_lost = in.u64();
    h.latency_p50_s = in.f64();
    h.latency_p99_s = in.f64();
    h.temperature_c = in.f64();
    h.active_faults = in.u32();
    h.clients = in.u32();
}

}  // namespace

std::uint16_t apid_of(const Telemetry& telemetry) {
    return std::holds_alternative<FrameReport>(telemetry) ? kFrameReportApid : kHousekeepingApid;
}

TimeTai time_of(const Telemetry& telemetry) {
    const auto* report = std::get_if<FrameReport>(&telemetry);
    return report ? report->exposure_mid : std::get<HousekeepingFigures>(telemetry).simulated_time;
}

void write_telemetry_body(const Telemetry& telemetry, ByteWriter& out) {
    std::visit([&](const auto& alternative) { write(out, alternative); }, telemetry);
}

bool read_telemetry_body(std::span<const std::uint8_t> body, Telemetry& telemetry) {
    ByteReader in(body);
    if (in.u8() != kProtocolVersion) return false;
    const std::uint8_t kind = in.u8();
    if (kind == kFrameReportKind && body.size() == kFrameReportBytes)
        read(in, telemetry.emplace<FrameReport>());
    else if (kind == kHousekeepingKind && body.size() == kHousekeepingBytes)
        read(in, telemetry.emplace<HousekeepingFigures>());
    else
        return false;
    return in.ok() && in.left() == 0;
}

std::size_t encode_telemetry(const Telemetry& telemetry, std::uint16_t count, std::span<std::uint8_t> bytes) {
    ByteWriter out(bytes.subspan(SpacePacketHeader::kBytes));
    write_telemetry_body(telemetry, out);
    return seal_packet({.apid = apid_of(telemetry), .count = count}, out.size(), bytes);
}

bool decode_telemetry(std::span<const std::uint8_t> packet, Telemetry& telemetry) {
    if (packet.size() < SpacePacketHeader::kBytes + kCrcBytes || crc16(packet) != 0) return false;
    const SpacePacketHeader header = read_packet_header(packet);
    if (header.version != 0 || header.command || header.total_bytes() != packet.size()) return false;
    const std::size_t body_bytes = packet.size() - SpacePacketHeader::kBytes - kCrcBytes;
    return read_telemetry_body(packet.subspan(SpacePacketHeader::kBytes, body_bytes), telemetry) &&
           header.apid == apid_of(telemetry);
}

}  // namespace hilcam
