#include "io/command_codec.h"

#include <algorithm>
#include <cmath>

#include "io/bytes.h"

namespace hilcam {
namespace {

enum Function : std::uint8_t { kPose = 1, kSettings = 2, kStart = 3, kStop = 4, kPing = 5, kJoint = 6 };
constexpr std::uint8_t kAcknowledgeBit = 0x80;
constexpr std::size_t kSecondaryBytes = 8;
constexpr std::size_t kCrcBytes = 2;

// Bytes of the payload, or -1 for a function that does not exist.
int payload_bytes(std::uint8_t function) {
    switch (function) {
        case kPose:
            return 2 + 2 + 8 + 13 * 8;
        case kSettings:
            return 4 + 3 * 8;
        case kStart:
            return 0;
        case kStop:
            return 0;
        case kPing:
            return 8;
        case kJoint:
            return 2 + 2 + 8 + 2 * 8;
        default:
            return -1;
    }
}

struct Refusal {
    CommandStatus status = CommandStatus::kAccepted;
    std::string_view reason;
};

Vec3d read_vec3(ByteReader& in) {
    const double x = in.f64(), y = in.f64(), z = in.f64();
    return {x, y, z};
}

Refusal read_pose(ByteReader& in, PoseCommand& pose) {
    pose.object = in.u16();
    in.u16();
    pose.motion.time.ns = in.i64();
    pose.motion.pose.position_world_m = read_vec3(in);
    pose.motion.velocity_world_m_s = read_vec3(in);
    Quat& q = pose.motion.pose.world_from_body;
    q.w = in.f64(), q.x = in.f64(), q.y = in.f64(), q.z = in.f64();
    pose.motion.rate_body_rad_s = read_vec3(in);
    if (!is_finite(pose.motion.pose.position_world_m) || !is_finite(pose.motion.velocity_world_m_s) ||
        !is_finite(pose.motion.rate_body_rad_s))
        return {CommandStatus::kBadArgument, "position, velocity or rate is not finite"};
    // 10 000 au, light speed, a thousand turns a second: beyond these a number is a mistake, and squares stay
    // finite.
    if (length(pose.motion.pose.position_world_m) > 1.5e15 || length(pose.motion.velocity_world_m_s) > 3e8 ||
        length(pose.motion.rate_body_rad_s) > 6300)
        return {CommandStatus::kBadArgument, "position, velocity or rate is out of range"};
    const double n = norm(q);
    if (!(std::abs(n - 1) <= 1e-3))
        return {CommandStatus::kBadArgument, "quaternion's norm is not 1 within 0.001"};
    q = normalized(q);
    return {};
}

Refusal read_settings(ByteReader& in, SettingsCommand& settings) {
    const std::uint32_t mask = in.u32();
    const std::array<double, 3> values = {in.f64(), in.f64(), in.f64()};
    if (mask == 0 || mask > 7) return {CommandStatus::kBadArgument, "mask of settings is not 1 to 7"};
    std::optional<double>* const targets[] = {&settings.exposure_s, &settings.gain_db,
                                              &settings.frame_rate_hz};
    for (std::size_t i = 0; i < 3; ++i) {
        if (!(mask >> i & 1u)) continue;
        if (!std::isfinite(values[i])) return {CommandStatus::kBadArgument, "a setting is not finite"};
        *targets[i] = values[i];
    }
    return {};
}

Refusal read_joint(ByteReader& in, JointCommand& joint) {
    joint.object = in.u16();
    joint.joint = in.u16();
    joint.time.ns = in.i64();
    joint.angle_rad = in.f64();
    joint.rate_rad_s = in.f64();
    if (!std::isfinite(joint.angle_rad) || !std::isfinite(joint.rate_rad_s))
        return {CommandStatus::kBadArgument, "angle or rate is not finite"};
    // A hundred thousand turns, a thousand a second: beyond these a number is a mistake.
    if (std::abs(joint.angle_rad) > 6.3e5 || std::abs(joint.rate_rad_s) > 6300)
        return {CommandStatus::kBadArgument, "angle or rate is out of range"};
    return {};
}

Refusal check_header(const SpacePacketHeader& h, std::size_t size) {
    if (h.total_bytes() != size) return {CommandStatus::kBadLength, "length field and packet differ"};
    if (h.version != 0 || !h.command || !h.secondary_header || h.sequence_flags != 3)
        return {CommandStatus::kBadHeader, "not an unsegmented telecommand with a secondary header"};
    if (h.apid != kCommandApid) return {CommandStatus::kUnknownApid, "APID is not 0x100"};
    return {};
}

Refusal read_body(ByteReader& in, std::uint8_t function, Command& command) {
    switch (function) {
        case kPose:
            return read_pose(in, command.emplace<PoseCommand>());
        case kSettings:
            return read_settings(in, command.emplace<SettingsCommand>());
        case kStart:
            command.emplace<StartCommand>();
            return {};
        case kStop:
            command.emplace<StopCommand>();
            return {};
        case kJoint:
            return read_joint(in, command.emplace<JointCommand>());
        default:
            command.emplace<PingCommand>().token = in.u64();
            return {};
    }
}

// Header, secondary header and CRC around a payload already in place.
std::size_t finish(std::span<std::uint8_t> bytes, bool command, std::uint16_t apid, std::uint16_t count,
                   std::size_t size_without_crc) {
    SpacePacketHeader header;
    header.command = command;
    header.apid = apid;
    header.count = count & 0x3FFF;
    header.data_length =
        static_cast<std::uint16_t>(size_without_crc + kCrcBytes - SpacePacketHeader::kBytes - 1);
    write_packet_header(header, bytes);
    ByteWriter(bytes.subspan(size_without_crc)).u16(crc16(bytes.first(size_without_crc)));
    return size_without_crc + kCrcBytes;
}

}  // namespace

DecodedCommand decode_command(std::span<const std::uint8_t> packet) {
    DecodedCommand out;
    const auto refuse = [&](Refusal refusal) {
        out.status = refusal.status;
        out.reason = refusal.reason;
        return out;
    };
    if (packet.size() < SpacePacketHeader::kBytes + kSecondaryBytes + kCrcBytes)
        return refuse({CommandStatus::kBadLength, "shorter than the shortest command"});
    out.header = read_packet_header(packet);
    ByteReader in(packet);
    in.skip(SpacePacketHeader::kBytes);
    const std::uint8_t version = in.u8();
    out.function = in.u8();
    in.u16();
    out.sequence = in.u32();
    if (const Refusal r = check_header(out.header, packet.size()); r.status != CommandStatus::kAccepted)
        return refuse(r);
    if (crc16(packet) != 0) return refuse({CommandStatus::kBadChecksum, "CRC-16 does not match"});
    if (version != kProtocolVersion) return refuse({CommandStatus::kBadHeader, "protocol version is not 1"});
    const int expected = payload_bytes(out.function);
    if (expected < 0) return refuse({CommandStatus::kUnknownFunction, "function code is not 1 to 6"});
    if (in.left() != static_cast<std::size_t>(expected) + kCrcBytes)
        return refuse({CommandStatus::kBadLength, "payload is not as long as its function's"});
    return refuse(read_body(in, out.function, out.command));
}

std::size_t encode_command(const Command& command, std::uint32_t sequence, std::span<std::uint8_t> bytes) {
    ByteWriter out(bytes);
    out.u16(0).u16(0).u16(0).u8(kProtocolVersion).u8(command.index() + 1).u16(0).u32(sequence);
    if (const auto* pose = std::get_if<PoseCommand>(&command)) {
        const Motion& m = pose->motion;
        out.u16(pose->object).u16(0).u64(static_cast<std::uint64_t>(m.time.ns));
        for (const Vec3d& v : {m.pose.position_world_m, m.velocity_world_m_s}) out.f64(v.x).f64(v.y).f64(v.z);
        const Quat& q = m.pose.world_from_body;
        out.f64(q.w).f64(q.x).f64(q.y).f64(q.z);
        out.f64(m.rate_body_rad_s.x).f64(m.rate_body_rad_s.y).f64(m.rate_body_rad_s.z);
    } else if (const auto* settings = std::get_if<SettingsCommand>(&command)) {
        out.u32((settings->exposure_s ? 1u : 0u) | (settings->gain_db ? 2u : 0u) |
                (settings->frame_rate_hz ? 4u : 0u));
        out.f64(settings->exposure_s.value_or(0)).f64(settings->gain_db.value_or(0));
        out.f64(settings->frame_rate_hz.value_or(0));
    } else if (const auto* ping = std::get_if<PingCommand>(&command)) {
        out.u64(ping->token);
    } else if (const auto* joint = std::get_if<JointCommand>(&command)) {
        out.u16(joint->object).u16(joint->joint).u64(static_cast<std::uint64_t>(joint->time.ns));
        out.f64(joint->angle_rad).f64(joint->rate_rad_s);
    }
    return finish(bytes, true, kCommandApid, static_cast<std::uint16_t>(sequence & 0x3FFF), out.size());
}

std::size_t encode_acknowledgement(const Acknowledgement& a, std::uint16_t count,
                                   std::span<std::uint8_t> bytes) {
    const std::size_t reason_bytes = std::min<std::size_t>(a.reason.size(), 96);
    ByteWriter out(bytes);
    out.u16(0).u16(0).u16(0).u8(kProtocolVersion).u8(a.function | kAcknowledgeBit);
    out.u8(static_cast<std::uint8_t>(a.status)).u8(0).u32(a.sequence).u64(a.token);
    out.u64(static_cast<std::uint64_t>(a.simulated_time.ns)).u16(reason_bytes);
    for (std::size_t i = 0; i < reason_bytes; ++i) out.u8(static_cast<std::uint8_t>(a.reason[i]));
    return finish(bytes, false, kAcknowledgeApid, count, out.size());
}

bool decode_acknowledgement(std::span<const std::uint8_t> packet, Acknowledgement& a) {
    if (packet.size() < SpacePacketHeader::kBytes + kCrcBytes || crc16(packet) != 0) return false;
    const SpacePacketHeader header = read_packet_header(packet);
    if (header.command || header.apid != kAcknowledgeApid || header.total_bytes() != packet.size())
        return false;
    ByteReader in(packet);
    in.skip(SpacePacketHeader::kBytes);
    if (in.u8() != kProtocolVersion) return false;
    a.function = in.u8() & static_cast<std::uint8_t>(~kAcknowledgeBit);
    a.status = static_cast<CommandStatus>(in.u8());
    in.u8();
    a.sequence = in.u32();
    a.token = in.u64();
    a.simulated_time.ns = in.i64();
    const std::size_t reason_bytes = in.u16();
    if (!in.ok() || in.left() != reason_bytes + kCrcBytes) return false;
    a.reason.assign(reinterpret_cast<const char*>(in.rest().data()), reason_bytes);
    return true;
}

std::string_view name_of(CommandStatus status) {
    switch (status) {
        case CommandStatus::kAccepted:
            return "accepted";
        case CommandStatus::kBadLength:
            return "bad length";
        case CommandStatus::kBadHeader:
            return "bad header";
        case CommandStatus::kUnknownApid:
            return "unknown APID";
        case CommandStatus::kBadChecksum:
            return "bad checksum";
        case CommandStatus::kUnknownFunction:
            return "unknown function";
        case CommandStatus::kBadArgument:
            return "bad argument";
        case CommandStatus::kUnknownObject:
            return "unknown object";
        case CommandStatus::kTimeOutOfRange:
            return "time out of range";
        case CommandStatus::kBusy:
            return "busy";
        case CommandStatus::kNotNow:
            return "not now";
    }
    return "unknown status";
}

}  // namespace hilcam
