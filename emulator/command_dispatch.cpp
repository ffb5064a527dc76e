#include "emulator/command_dispatch.h"

#include <cmath>

namespace hilcam {
namespace {
constexpr std::int64_t kFarthestTag_ns = 3'600'000'000'000;  // an hour
constexpr double kPatience_s = 600;                          // for the frames of one order in lockstep

CommandStatus status_of(TriggerResult result) {
    switch (result) {
        case TriggerResult::kTaken:
            return CommandStatus::kAccepted;
        case TriggerResult::kMissed:
            return CommandStatus::kBusy;
        case TriggerResult::kTooEarly:
            return CommandStatus::kTimeOutOfRange;
        default:
            return CommandStatus::kNotNow;
    }
}

}  // namespace

CommandStatus CommandDispatch::handle(const Command& command, std::uint32_t sequence,
                                      std::int64_t arrival_monotonic_ns) {
    if (const auto* pose = std::get_if<PoseCommand>(&command))
        return set_pose(*pose, sequence, arrival_monotonic_ns);
    if (const auto* joint = std::get_if<JointCommand>(&command))
        return turn(*joint, sequence, arrival_monotonic_ns);
    if (const auto* settings = std::get_if<SettingsCommand>(&command)) return change(*settings);
    if (const auto* expose = std::get_if<ExposeCommand>(&command))
        return trigger(*expose, sequence, arrival_monotonic_ns);
    if (const auto* mode = std::get_if<TriggerModeCommand>(&command)) return set_trigger_mode(*mode);
    if (const auto* fault = std::get_if<FaultCommand>(&command)) return order(*fault);
    SettingsChange running;
    if (std::holds_alternative<StartCommand>(command)) running.running = true;
    if (std::holds_alternative<StopCommand>(command)) running.running = false;
    settings_.change(running);
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
    if (!resolve(motion.time, clock_.of_arrival(arrival_monotonic_ns))) return CommandStatus::kTimeOutOfRange;
    return world_.set(pose.object, motion, {sequence, arrival_monotonic_ns}) ? CommandStatus::kAccepted
                                                                             : CommandStatus::kUnknownObject;
}

CommandStatus CommandDispatch::turn(const JointCommand& joint, std::uint32_t sequence,
                                    std::int64_t arrival_monotonic_ns) {
    WorldState::JointMotion motion{joint.time, joint.angle_rad, joint.rate_rad_s};
    if (!resolve(motion.time, clock_.of_arrival(arrival_monotonic_ns))) return CommandStatus::kTimeOutOfRange;
    return world_.set_joint(joint.object, joint.joint, motion, {sequence, arrival_monotonic_ns})
               ? CommandStatus::kAccepted
               : CommandStatus::kUnknownObject;
}

CommandStatus CommandDispatch::change(const SettingsCommand& s) {
    SettingsChange change;
    change.exposure_s = s.exposure_s;
    change.gain_db = s.gain_db;
    change.frame_rate_hz = s.frame_rate_hz;
    return settings_.change(change) ? CommandStatus::kAccepted : CommandStatus::kBadArgument;
}

CommandStatus CommandDispatch::set_trigger_mode(const TriggerModeCommand& m) {
    SettingsChange change;
    change.triggered = m.triggered;
    if (m.triggered) change.trigger_source = TriggerSource::kLine0;
    if (m.burst_frames > 0) change.burst_frames = m.burst_frames;
    return settings_.change(change) ? CommandStatus::kAccepted : CommandStatus::kNotNow;
}

CommandStatus CommandDispatch::trigger(const ExposeCommand& e, std::uint32_t sequence,
                                       std::int64_t arrival_monotonic_ns) {
    TriggerOrder order;
    order.source = TriggerSource::kLine0;
    order.frames = e.frames;
    order.sequence = sequence;
    if (settings_.limits().lockstep) {
        order.at_simulated = e.time;
        return status_of(settings_.trigger_and_wait(order, kPatience_s));
    }
    TimeTai tag = e.time;
    if (!resolve(tag, clock_.of_arrival(arrival_monotonic_ns))) return CommandStatus::kTimeOutOfRange;
    order.at_monotonic_ns = clock_.monotonic_at(tag);
    return status_of(settings_.trigger(order));
}

CommandStatus CommandDispatch::order(const FaultCommand& f) {
    if (f.clear_all) {
        faults_.clear_all();
        return CommandStatus::kAccepted;
    }
    if (!refusal_of(f.order).empty()) return CommandStatus::kBadArgument;
    faults_.order(f.order);
    return CommandStatus::kAccepted;
}

}  // namespace hilcam
