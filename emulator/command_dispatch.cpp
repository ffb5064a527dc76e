#include "emulator/command_dispatch.h"

#include <cmath>

namespace hilcam {
namespace {
constexpr std::int64_t kFarthestTag_ns = 3'600'000'000'000;  // an hour
}

CommandStatus CommandDispatch::handle(const Command& command, std::uint32_t sequence,
                                      std::int64_t arrival_monotonic_ns) {
    if (const auto* pose = std::get_if<PoseCommand>(&command))
        return set_pose(*pose, sequence, arrival_monotonic_ns);
    if (const auto* joint = std::get_if<JointCommand>(&command))
        return turn(*joint, sequence, arrival_monotonic_ns);
    if (const auto* settings = std::get_if<SettingsCommand>(&command)) return change(*settings);
    if (std::holds_alternative<StartCommand>(command)) settings_.set_running(true);
    if (std::holds_alternative<StopCommand>(command)) settings_.set_running(false);
    return CommandStatus::kAccepted;
}

// A tag of 0 is the arrival; false for one too far from it.
bool CommandDispatch::resolve(TimeTai& tag, TimeTai arrival) {
    if (tag.ns == 0) tag = arrival;
    // Compared without subtracting: a hostile tag must not overflow.
    return !(tag < arrival + -kFarthestTag_ns || arrival + kFarthestTag_ns < tag);
}

CommandStatus CommandDispatch::set_pose(const PoseCommand& pose, std::uint32_t sequence,
                                        std::int64_t arrival_monotonic_ns) {
    Motion motion = pose.motion;
    if (!resolve(motion.time, clock_.at(arrival_monotonic_ns))) return CommandStatus::kTimeOutOfRange;
    return world_.set(pose.object, motion, {sequence, arrival_monotonic_ns}) ? CommandStatus::kAccepted
                                                                             : CommandStatus::kUnknownObject;
}

CommandStatus CommandDispatch::turn(const JointCommand& joint, std::uint32_t sequence,
                                    std::int64_t arrival_monotonic_ns) {
    WorldState::JointMotion motion{joint.time, joint.angle_rad, joint.rate_rad_s};
    if (!resolve(motion.time, clock_.at(arrival_monotonic_ns))) return CommandStatus::kTimeOutOfRange;
    return world_.set_joint(joint.object, joint.joint, motion, {sequence, arrival_monotonic_ns})
               ? CommandStatus::kAccepted
               : CommandStatus::kUnknownObject;
}

// All or nothing: a value outside its limits leaves every setting as it was.
CommandStatus CommandDispatch::change(const SettingsCommand& s) {
    const CameraLimits l = settings_.limits();
    const auto inside = [](const std::optional<double>& value, double least, double most) {
        return !value || (*value >= least && *value <= most);
    };
    if (!inside(s.exposure_s, l.least_exposure_s, l.most_exposure_s) ||
        !inside(s.gain_db, l.least_gain_db, l.most_gain_db) ||
        !inside(s.frame_rate_hz, l.least_frame_rate_hz, l.most_frame_rate_hz))
        return CommandStatus::kBadArgument;
    if ((s.exposure_s && l.exposure_is_own) || (s.gain_db && l.gain_is_own) ||
        (s.frame_rate_hz && l.frame_rate_is_own))
        return CommandStatus::kBadArgument;
    if (s.exposure_s) settings_.set_exposure_s(*s.exposure_s);
    if (s.gain_db) settings_.set_gain_db(*s.gain_db);
    if (s.frame_rate_hz) settings_.set_frame_rate_hz(*s.frame_rate_hz);
    return CommandStatus::kAccepted;
}

}  // namespace hilcam
