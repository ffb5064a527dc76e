#include "io/commands/acknowledgement.h"

#include <algorithm>
#include <array>

#include "io/commands/ccsds.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

constexpr std::uint8_t kAcknowledgeBit = 0x80;
constexpr std::size_t kMaxReasonBytes = 96;
constexpr std::size_t kClockBytes = 5 * 8;

void write(ByteWriter& out, const ClockReading& r) {
    out.u64(static_cast<std::uint64_t>(r.arrival.ns)).u64(static_cast<std::uint64_t>(r.arrival_monotonic_ns));
    out.u64(static_cast<std::uint64_t>(r.departure_monotonic_ns)).f64(r.scale);
    out.u64(static_cast<std::uint64_t>(r.stands_at.ns));
}
ClockReading read_clock(ByteReader& in, TimeTai departure) {
    ClockReading r;
    r.departure = departure;
    r.arrival.ns = in.i64();
    r.arrival_monotonic_ns = in.i64();
    r.departure_monotonic_ns = in.i64();
    r.scale = in.f64();
    r.stands_at.ns = in.i64();
    return r;
}

}  // namespace

void write_acknowledgement_body(const Acknowledgement& a, ByteWriter& out) {
    const std::size_t reason_bytes = std::min(a.reason.size(), kMaxReasonBytes);
    out.u8(kProtocolVersion).u8(a.function | kAcknowledgeBit);
    out.u8(static_cast<std::uint8_t>(a.status)).u8(0).u32(a.sequence).u64(a.token);
    out.u64(static_cast<std::uint64_t>(a.simulated_time.ns)).u16(reason_bytes);
    for (std::size_t i = 0; i < reason_bytes; ++i) out.u8(static_cast<std::uint8_t>(a.reason[i]));
    if (a.clock) write(out, *a.clock);
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
    const bool has_clock = a.function == kClockFunction && in.left() == reason_bytes + kClockBytes;
    if (!in.ok() || (in.left() != reason_bytes && !has_clock)) return false;
    a.reason.assign(reinterpret_cast<const char*>(in.rest().data()), reason_bytes);
    in.skip(reason_bytes);
    a.clock.reset();
    if (has_clock) a.clock = read_clock(in, a.simulated_time);
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
    // The names, by number.
    constexpr std::array<std::string_view, 12> kNames = {
        "accepted",         "bad length",    "bad header",     "unknown APID",      "bad checksum",
        "unknown function", "bad argument",  "unknown object", "time out of range", "busy",
        "not now",          "time went back"};
    const auto number = static_cast<std::size_t>(status);
    return number < kNames.size() ? kNames[number] : "unknown status";
}

std::string text_of(const Acknowledgement& a) {
    const std::string name(name_of(a.status));
    return a.reason.empty() ? name : name + ": " + harmless(a.reason.substr(0, kMaxReasonBytes));
}

std::string_view meaning_of(CommandStatus status) {
    switch (status) {
        case CommandStatus::kUnknownObject:
            return "the bench has no object, joint, lamp or camera of this number";
        case CommandStatus::kTimeOutOfRange:
            return "beyond commands.poses.horizon_s from simulated time, or in lockstep not after the last "
                   "frame";
        case CommandStatus::kBusy:
            return "the trigger's time has passed, the frame before is still exposed, or too many wait";
        case CommandStatus::kNotNow:
            return "the camera's mode, or the clock's, has no use for it";
        case CommandStatus::kTimeBackwards:
            return "the time tag lies before the newest of its thing";
        default:
            return name_of(status);
    }
}

std::string_view meaning_of(CommandStatus status, const Command& command) {
    if (status != CommandStatus::kNotNow) return meaning_of(status);
    if (std::holds_alternative<ExposeCommand>(command))
        return "no trigger is taken in free_run ('hilcam send mode triggered') or when stopped ('... start')";
    if (std::holds_alternative<TriggerModeCommand>(command))
        return "in lockstep each 'expose' takes a frame, and nothing else does";
    if (std::holds_alternative<ClockCommand>(command))
        return "in lockstep time goes from frame to frame; else 'hilcam send clock pause' before a step";
    return meaning_of(status);
}

}  // namespace hilcam
