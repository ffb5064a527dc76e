#include "io/commands/command_payload.h"

#include <array>
#include <cmath>

#include "render/sky/motion_bounds.h"

namespace hilcam {
namespace {

struct Layout {
    std::string_view name;
    std::size_t bytes;
};
// Layouts by function code - 1.
constexpr std::array<Layout, 12> kLayouts = {{
    {"pose", 2 + 2 + 8 + 13 * 8},
    {"settings", 4 + 3 * 8},
    {"start", 0},
    {"stop", 0},
    {"ping", 8},
    {"joint", 2 + 2 + 8 + 2 * 8},
    {"fault", 4 + 5 * 8},
    {"expose", 2 + 2 + 8},
    {"mode", 4},
    {"subscribe", 4},
    {"clock", 4 + 3 * 8},
    {"lamp", 2 + 2 + 8 + 8},
}};
static_assert(std::variant_size_v<Command> == kLayouts.size());
static_assert(std::is_same_v<std::variant_alternative_t<6, Command>, FaultCommand>);
static_assert(std::is_same_v<std::variant_alternative_t<9, Command>, SubscribeCommand>);
static_assert(std::is_same_v<std::variant_alternative_t<kClockFunction - 1, Command>, ClockCommand>);
// Bits for the settings in a settings command, and for the kinds in a subscription.
constexpr std::uint32_t kExposureBit = 1, kGainBit = 2, kFrameRateBit = 4;
constexpr std::uint8_t kFrameReportsBit = 1, kHousekeepingBit = 2;

Refusal bad(std::string_view reason) { return {CommandStatus::kBadArgument, reason}; }

Vec3d read_vec3(ByteReader& in) {
    const double x = in.f64(), y = in.f64(), z = in.f64();
    return {x, y, z};
}
void write_vec3(ByteWriter& out, const Vec3d& v) { out.f64(v.x).f64(v.y).f64(v.z); }

Refusal read(ByteReader& in, PoseCommand& pose) {
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
        return bad("position, velocity or rate is not finite");
    if (!is_turn(q)) return bad("quaternion's norm is not 1 within 0.001");
    if (!is_possible(pose.motion)) return bad("position, velocity or rate is out of range");
    q = normalized(q);
    return {};
}
void write(ByteWriter& out, const PoseCommand& pose) {
    const Motion& m = pose.motion;
    out.u16(pose.object).u16(0).u64(static_cast<std::uint64_t>(m.time.ns));
    write_vec3(out, m.pose.position_world_m);
    write_vec3(out, m.velocity_world_m_s);
    const Quat& q = m.pose.world_from_body;
    out.f64(q.w).f64(q.x).f64(q.y).f64(q.z);
    write_vec3(out, m.rate_body_rad_s);
}

Refusal read(ByteReader& in, SettingsCommand& settings) {
    const std::uint32_t mask = in.u32();
    const std::array<double, 3> values = {in.f64(), in.f64(), in.f64()};
    if (mask == 0 || mask > 7) return bad("mask of settings is not 1 to 7");
    std::optional<double>* const targets[] = {&settings.exposure_s, &settings.gain_db,
                                              &settings.frame_rate_hz};
    for (std::size_t i = 0; i < 3; ++i) {
        if (!(mask >> i & 1u)) continue;
        if (!std::isfinite(values[i])) return bad("a setting is not finite");
        *targets[i] = values[i];
    }
    return {};
}
void write(ByteWriter& out, const SettingsCommand& s) {
    out.u32((s.exposure_s ? kExposureBit : 0u) | (s.gain_db ? kGainBit : 0u) |
            (s.frame_rate_hz ? kFrameRateBit : 0u));
    out.f64(s.exposure_s.value_or(0)).f64(s.gain_db.value_or(0)).f64(s.frame_rate_hz.value_or(0));
}

Refusal read(ByteReader&, StartCommand&) { return {}; }
void write(ByteWriter&, const StartCommand&) {}
Refusal read(ByteReader&, StopCommand&) { return {}; }
void write(ByteWriter&, const StopCommand&) {}

Refusal read(ByteReader& in, PingCommand& ping) {
    ping.token = in.u64();
    return {};
}
void write(ByteWriter& out, const PingCommand& ping) { out.u64(ping.token); }

Refusal read(ByteReader& in, JointCommand& joint) {
    joint.object = in.u16();
    joint.joint = in.u16();
    joint.time.ns = in.i64();
    joint.angle_rad = in.f64();
    joint.rate_rad_s = in.f64();
    if (!std::isfinite(joint.angle_rad) || !std::isfinite(joint.rate_rad_s))
        return bad("angle or rate is not finite");
    if (!is_possible_turn_of_joint(joint.angle_rad, joint.rate_rad_s))
        return bad("angle or rate is out of range");
    return {};
}
void write(ByteWriter& out, const JointCommand& joint) {
    out.u16(joint.object).u16(joint.joint).u64(static_cast<std::uint64_t>(joint.time.ns));
    out.f64(joint.angle_rad).f64(joint.rate_rad_s);
}

// Kind 0 clears all faults.
Refusal read(ByteReader& in, FaultCommand& fault) {
    const std::uint8_t kind = in.u8();
    in.skip(3);
    fault.order.rate = in.f64();
    fault.order.value = in.f64();
    fault.order.from_frame = in.u64();
    fault.order.frames = in.u64();
    fault.order.duration_s = in.f64();
    fault.clear_all = kind == 0;
    if (fault.clear_all) {
        fault.order = {};
        return {};
    }
    fault.order.kind = static_cast<FaultKind>(kind);
    const std::string_view reason = refusal_of(fault.order);
    return reason.empty() ? Refusal{} : bad(reason);
}
void write(ByteWriter& out, const FaultCommand& fault) {
    const FaultOrder order = fault.clear_all ? FaultOrder{} : fault.order;
    out.u8(fault.clear_all ? 0u : static_cast<std::uint8_t>(order.kind)).u8(0).u16(0);
    out.f64(order.rate).f64(order.value).u64(order.from_frame).u64(order.frames).f64(order.duration_s);
}

Refusal read(ByteReader& in, ExposeCommand& expose) {
    expose.frames = in.u16();
    in.u16();
    expose.time.ns = in.i64();
    return {};
}
void write(ByteWriter& out, const ExposeCommand& expose) {
    out.u16(expose.frames).u16(0).u64(static_cast<std::uint64_t>(expose.time.ns));
}

Refusal read(ByteReader& in, TriggerModeCommand& mode) {
    const std::uint8_t triggered = in.u8();
    in.u8();
    mode.burst_frames = in.u16();
    mode.triggered = triggered == 1;
    return triggered <= 1 ? Refusal{} : bad("mode is not 0 (free-run) or 1 (triggered)");
}
void write(ByteWriter& out, const TriggerModeCommand& mode) {
    out.u8(mode.triggered ? 1u : 0u).u8(0).u16(mode.burst_frames);
}

Refusal read(ByteReader& in, SubscribeCommand& subscribe) {
    const std::uint8_t mask = in.u8();
    in.skip(3);
    subscribe.frame_reports = (mask & kFrameReportsBit) != 0;
    subscribe.housekeeping = (mask & kHousekeepingBit) != 0;
    return mask <= 3 ? Refusal{} : bad("mask of telemetry is not 0 to 3");
}
void write(ByteWriter& out, const SubscribeCommand& s) {
    out.u8((s.frame_reports ? kFrameReportsBit : 0u) | (s.housekeeping ? kHousekeepingBit : 0u)).u8(0).u16(0);
}

// Fields that the action does not need are not examined.
Refusal read(ByteReader& in, ClockCommand& clock) {
    using Action = ClockCommand::Action;
    const std::uint8_t action = in.u8();
    in.skip(3);
    clock.sender_ns = in.i64();
    clock.scale = in.f64();
    clock.step_ns = in.i64();
    if (action > static_cast<std::uint8_t>(Action::kStep)) return bad("action of the clock is not 0 to 4");
    clock.action = static_cast<Action>(action);
    if (clock.action != Action::kScale)
        clock.scale = 1;
    else if (!(clock.scale >= kMinClockScale && clock.scale <= kMaxClockScale))
        return bad("scale of time is not 0.001 to 1000");
    if (clock.action != Action::kStep)
        clock.step_ns = 0;
    else if (clock.step_ns < 1 || clock.step_ns > kMaxClockStep_ns)
        return bad("step of time is not 1 to 1e16 ns");
    return {};
}
void write(ByteWriter& out, const ClockCommand& clock) {
    out.u8(static_cast<std::uint8_t>(clock.action)).u8(0).u16(0);
    out.u64(static_cast<std::uint64_t>(clock.sender_ns)).f64(clock.scale);
    out.u64(static_cast<std::uint64_t>(clock.step_ns));
}

Refusal read(ByteReader& in, LampCommand& lamp) {
    lamp.lamp = in.u16();
    in.u16();
    lamp.time.ns = in.i64();
    lamp.level = in.f64();
    return lamp.level >= 0 && lamp.level <= 1 ? Refusal{} : bad("level of a lamp is not 0 to 1");
}
void write(ByteWriter& out, const LampCommand& lamp) {
    out.u16(lamp.lamp).u16(0).u64(static_cast<std::uint64_t>(lamp.time.ns)).f64(lamp.level);
}

// Constructs and reads the alternative for a function code.
template <std::size_t... I>
Refusal read_alternative(ByteReader& in, std::size_t index, Command& command, std::index_sequence<I...>) {
    Refusal refusal;
    ((index == I && (refusal = read(in, command.emplace<I>()), true)) || ...);
    return refusal;
}

}  // namespace

std::uint8_t function_of(const Command& command) { return static_cast<std::uint8_t>(command.index() + 1); }

std::string_view name_of_function(std::uint8_t function) {
    return function >= 1 && function <= kLayouts.size() ? kLayouts[function - 1u].name : std::string_view{};
}

std::optional<std::size_t> payload_bytes(std::uint8_t function) {
    if (function < 1 || function > kLayouts.size()) return {};
    return kLayouts[function - 1u].bytes;
}

Refusal read_payload(ByteReader& in, std::uint8_t function, Command& command) {
    return read_alternative(in, function - std::size_t{1}, command,
                            std::make_index_sequence<std::variant_size_v<Command>>{});
}

void write_payload(const Command& command, ByteWriter& out) {
    std::visit([&](const auto& alternative) { write(out, alternative); }, command);
}

}  // namespace hilcam
