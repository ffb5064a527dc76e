#include "emulator/run/command_dispatch.h"

#include <cmath>

#include "emulator/recording/recorder.h"
#include "emulator/run/event_director.h"
#include "io/contract/refused_settings.h"
#include "io/lines/camera_lines.h"
#include "render/sky/motion_bounds.h"
#include "render/vocabulary/overloaded.h"

namespace hilcam {
namespace {

constexpr double kPatience_s = 600;  // for all frames of one order in lockstep

CommandStatus status_of(TriggerResult result) {
    switch (result) {
        case TriggerResult::kTaken:
            return CommandStatus::kAccepted;
        case TriggerResult::kMissed:
            return CommandStatus::kBusy;
        case TriggerResult::kTooEarly:
            return CommandStatus::kTimeOutOfRange;
        case TriggerResult::kNotArmed:
            break;
    }
    return CommandStatus::kNotNow;
}

// Returns the status of a trigger. A camera that has ended its run says so.
CommandStatus answer_of(const CommandedCamera& camera, TriggerResult result, CommandNotes* notes) {
    if (notes && result == TriggerResult::kNotArmed && camera.settings->is_closed())
        notes->why = "the run ends: no more frames are taken (--frames, --duration, or it was stopped)";
    return status_of(result);
}

SettingsChange change_of(const SettingsCommand& s) {
    SettingsChange change;
    change.exposure_s = s.exposure_s;
    change.gain_db = s.gain_db;
    change.frame_rate_hz = s.frame_rate_hz;
    return change;
}

SettingsChange change_of(const TriggerModeCommand& m) {
    SettingsChange change;
    change.triggered = m.triggered;
    if (m.triggered) change.trigger_source = TriggerSource::kLine0;
    if (m.burst_frames > 0) change.burst_frames = m.burst_frames;
    return change;
}

// True for commands that are recorded after they have been accepted. Poses, joints and lamps are recorded
// before they take effect, so that no frame shows one that is not recorded. Queries are not recorded.
bool is_noted_after(const Command& command) {
    return std::visit(
        Overloaded{
            [](const OneOf<PoseCommand, JointCommand, LampCommand> auto&) { return false; },
            [](const OneOf<PingCommand, SubscribeCommand> auto&) { return false; },
            [](const ClockCommand& clock) { return clock.action != ClockCommand::Action::kAsk; },
            [](const OneOf<SettingsCommand, StartCommand, StopCommand, FaultCommand, ExposeCommand,
                           TriggerModeCommand> auto&) { return true; },
        },
        command);
}

// True for a fault over a number of frames, or from an event: it does not strike a frame that is already
// being made.
bool is_from_next_frame(const FaultCommand& f, const CommandSource& source) {
    return !f.clear_all && f.order.from_frame == 0 && (f.order.frames != 0 || source.event != 0);
}

}  // namespace

CommandStatus CommandDispatch::handle(const Command& command, const CommandSource& source) {
    if (const auto* fault = std::get_if<FaultCommand>(&command); fault && is_from_next_frame(*fault, source))
        return order_from_next_frame(*fault, source);
    const CommandStatus status = perform(command, source);
    if (recorder_ && status == CommandStatus::kAccepted && is_noted_after(command)) {
        const std::lock_guard one(recording_);
        note(command, source, false);
    }
    return status;
}

// Records the command and returns its number.
std::uint64_t CommandDispatch::note(const Command& command, const CommandSource& source, bool forgets) {
    const std::uint64_t number = recorder_->next_number();
    RecordedCommand record{number, command, source, forgets};
    record.source.notes = nullptr;  // belongs to the sender, and only for now
    recorder_->put(record);
    return number;
}

// Has no default, so that a new command does not compile until it is handled here.
CommandStatus CommandDispatch::perform(const Command& command, const CommandSource& source) {
    return std::visit(
        Overloaded{
            [&](const PoseCommand& pose) { return set_pose(pose, source); },
            [&](const JointCommand& joint) { return turn(joint, source); },
            [&](const LampCommand& lamp) { return switch_lamp(lamp, source); },
            [&](const SettingsCommand& settings) {
                return change(change_of(settings), source, CommandStatus::kBadArgument);
            },
            [&](const TriggerModeCommand& mode) {
                return change(change_of(mode), source, CommandStatus::kNotNow);
            },
            [&](const ExposeCommand& exposure) { return expose(exposure, source); },
            [&](const FaultCommand& fault) { return order(fault, source); },
            [&](const ClockCommand& clock) { return order(clock); },
            [&](const StartCommand&) { return change({.running = true}, source, CommandStatus::kNotNow); },
            [&](const StopCommand&) { return change({.running = false}, source, CommandStatus::kNotNow); },
            // The command station answers these itself (io/commands/command_station.cpp), without the
            // cameras.
            [](const OneOf<PingCommand, SubscribeCommand> auto&) { return CommandStatus::kAccepted; },
        },
        command);
}

// Calls several cameras. The first refusal is the answer, and the notes say which camera refused.
template <class F>
CommandStatus CommandDispatch::for_cameras(std::uint16_t camera, F&& act, CommandNotes* notes) {
    if (camera > cameras_.size()) return CommandStatus::kUnknownObject;
    CommandStatus status = CommandStatus::kAccepted;
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
        if (camera != 0 && camera != i + 1) continue;
        const CommandStatus own = act(cameras_[i]);
        if (status != CommandStatus::kAccepted || own == status) continue;
        status = own;
        if (notes && camera == 0 && cameras_.size() > 1)
            notes->refused_by = static_cast<std::uint16_t>(i + 1);
    }
    return status;
}

void CommandDispatch::wake_cameras() {
    for (const CommandedCamera& c : cameras_) c.settings->wake();
}

CommandStatus CommandDispatch::order(const ClockCommand& clock) {
    const CommandStatus status = clock_.order(clock);
    if (clock.action != ClockCommand::Action::kAsk) wake_cameras();
    return status;
}

// Resolves a tag: 0 means the arrival. Returns false for a tag too far from it. In lockstep any tag is
// accepted.
bool CommandDispatch::resolve(TimeTai& tag, const CommandSource& source) const {
    const TimeTai arrival = clock_.of_arrival(source.arrival_monotonic_ns);
    if (tag.ns == 0) tag = arrival;
    // Compares without subtraction, so that a hostile tag cannot overflow.
    const std::int64_t horizon_ns = poses_.horizon_ns();
    return clock_.lockstep() || !(tag < arrival + -horizon_ns || arrival + horizon_ns < tag);
}

// set: moves a thing in one camera's world; its last argument says whether to forget earlier motion. anew:
// the sender says that its time restarts. tag: the command's own tag, which is resolved.
template <class C, class F>
CommandStatus CommandDispatch::move(const C& command, PoseWatch::Subject subject, TimeTai& tag,
                                    const CommandSource& source, bool anew, F&& set) {
    using Verdict = PoseWatch::Verdict;
    const bool tagged = tag.ns != 0 && !anew;
    if (!resolve(tag, source)) return CommandStatus::kTimeOutOfRange;
    const Verdict verdict = tagged ? poses_.judge(subject, tag) : Verdict::kForwards;
    if (source.notes) source.notes->went_back = verdict != Verdict::kForwards;
    const TimeTai arrival = clock_.of_arrival(source.arrival_monotonic_ns);
    const bool stopped = poses_.stops(arrival);
    CommandStatus status = CommandStatus::kTimeBackwards;
    if (verdict != Verdict::kRefused) {
        const bool forgets = anew || verdict == Verdict::kBackwards;
        ShownCommand shown{source.sequence, source.arrival_monotonic_ns, {}, 0};
        std::unique_lock one(recording_, std::defer_lock);
        if (recorder_) {
            one.lock();
            shown.number = note(command, source, forgets);
        }
        status = for_cameras(0, [&](const CommandedCamera& c) {
            return set(*c.world, shown, forgets) ? CommandStatus::kAccepted : CommandStatus::kUnknownObject;
        });
    }
    if (status == CommandStatus::kUnknownObject) return status;
    poses_.took(subject, tag, arrival, anew ? Verdict::kAnew : verdict);
    if (source.notes)
        source.notes->notify_sender =
            verdict == Verdict::kBackwards && poses_.rules().backwards == WhenBackwards::kFlag;
    if (stopped) wake_cameras();
    return status;
}

CommandStatus CommandDispatch::set_pose(const PoseCommand& pose, const CommandSource& source) {
    if (!cameras_.front().world->thing_of(pose.object)) return CommandStatus::kUnknownObject;
    if (!is_possible(pose.motion)) return CommandStatus::kBadArgument;
    PoseCommand resolved = pose;
    return move(resolved, {pose.object, 0}, resolved.motion.time, source, pose.alone,
                [&](WorldState& world, const ShownCommand& shown, bool anew) {
                    return world.set(pose.object, resolved.motion, shown, anew);
                });
}

CommandStatus CommandDispatch::turn(const JointCommand& joint, const CommandSource& source) {
    if (!cameras_.front().world->thing_of(joint.object, joint.joint)) return CommandStatus::kUnknownObject;
    if (!is_possible_turn_of_joint(joint.angle_rad, joint.rate_rad_s)) return CommandStatus::kBadArgument;
    JointCommand resolved = joint;
    return move(resolved, {joint.object, joint.joint}, resolved.time, source, false,
                [&](WorldState& world, const ShownCommand& shown, bool anew) {
                    return world.set_joint(joint.object, joint.joint,
                                           {resolved.time, joint.angle_rad, joint.rate_rad_s}, shown, anew);
                });
}

CommandStatus CommandDispatch::switch_lamp(const LampCommand& lamp, const CommandSource& source) {
    if (!cameras_.front().world->thing_of_lamp(lamp.lamp)) return CommandStatus::kUnknownObject;
    LampCommand resolved = lamp;
    return move(resolved, {0, 0, lamp.lamp}, resolved.time, source, false,
                [&](WorldState& world, const ShownCommand& shown, bool anew) {
                    return world.set_lamp(lamp.lamp, {resolved.time, lamp.level}, shown, anew);
                });
}

// Returns the instant in the camera's time from which settings by a sender or event are valid. An event may
// be carried out before or after its time. If time will stand still before that, settings are valid at once.
std::int64_t CommandDispatch::settings_hold_from(const CommandSource& source) const {
    const std::int64_t due_ns = source.due.ns == 0 ? SimulatedClock::kNever_ns : clock_.camera_of(source.due);
    return due_ns == SimulatedClock::kNever_ns ? clock_.camera_at(source.arrival_monotonic_ns) : due_ns;
}

// Changes all addressed cameras, or none.
CommandStatus CommandDispatch::change(const SettingsChange& change, const CommandSource& source,
                                      CommandStatus refused) {
    const std::int64_t from_ns = settings_hold_from(source);
    const auto judged = [&](LiveSettings& settings, bool is_done) {
        if (!is_done && source.notes && source.notes->why.empty())
            source.notes->why = refusal_of(change, settings.settings(), settings.limits());
        return is_done ? CommandStatus::kAccepted : refused;
    };
    const auto change_all = [&](const auto& is_done) {
        return for_cameras(
            source.camera,
            [&](const CommandedCamera& c) { return judged(*c.settings, is_done(*c.settings)); },
            source.notes);
    };
    const CommandStatus status = change_all([&](const LiveSettings& s) { return s.takes(change); });
    if (status != CommandStatus::kAccepted) return status;
    return change_all([&](LiveSettings& s) { return s.change(change, from_ns); });
}

CommandStatus CommandDispatch::expose(const ExposeCommand& e, const CommandSource& source) {
    TriggerOrder order;
    order.source = TriggerSource::kLine0;
    order.frames = e.frames;
    order.sequence = source.sequence;
    order.at_any_time = e.at_any_time;
    if (clock_.lockstep()) {
        order.at_simulated = e.time;
        return expose_in_lockstep(order, source);
    }
    TimeTai tag = e.time;
    if (!resolve(tag, source)) return CommandStatus::kTimeOutOfRange;
    order.at_monotonic_ns = source.arrival_monotonic_ns;
    if (e.time.ns != 0) order.at_simulated = tag;
    return for_cameras(
        source.camera,
        [&](const CommandedCamera& c) {
            const TriggerResult result = c.lines ? c.lines->pulse(order) : c.settings->trigger(order);
            return answer_of(c, result, source.notes);
        },
        source.notes);
}

// Exposes in lockstep. With events, each frame is an order of its own, so that events can happen between any
// two frames. A picture that an event takes belongs to the sender's current order; without a sender, only
// events can order one (event_director.h).
CommandStatus CommandDispatch::expose_in_lockstep(const TriggerOrder& order, const CommandSource& source) {
    std::unique_lock one(lockstep_, std::defer_lock);
    if (source.event == 0) one.lock();
    if (!events_) return run_order(order, source);
    TriggerOrder frame = order;
    frame.frames = 1;
    const std::int64_t burst = cameras_.front().settings->settings().burst_frames;
    const std::int64_t frames = order.frames > 0 ? order.frames : burst;
    for (std::int64_t i = 0; i < frames; ++i) {
        events_->before_frame(frame);
        if (events_->asks_to_end()) return CommandStatus::kNotNow;
        const CommandStatus status = run_order(frame, source);
        if (status != CommandStatus::kAccepted) return status;
        frame.at_simulated = {};  // one period later
    }
    return CommandStatus::kAccepted;
}

// Answers when the loops have sampled the world for the order's last frame. Later commands do not affect its
// frames, so the same commands give the same frames at any pace.
CommandStatus CommandDispatch::run_order(const TriggerOrder& order, const CommandSource& source) {
    const CommandStatus status = for_cameras(
        source.camera,
        [&](const CommandedCamera& c) {
            return answer_of(c, c.settings->order_in_lockstep(order), source.notes);
        },
        source.notes);
    const CommandStatus done = for_cameras(source.camera, [&](const CommandedCamera& c) {
        return c.settings->wait_for_order(kPatience_s) ? CommandStatus::kAccepted : CommandStatus::kBusy;
    });
    return status == CommandStatus::kAccepted ? done : status;
}

// The next frame has a different number on each camera, and a recording must state it, so each camera gets
// its own order.
CommandStatus CommandDispatch::order_from_next_frame(FaultCommand f, const CommandSource& source) {
    return for_cameras(source.camera, [&](const CommandedCamera& c) {
        CommandSource own = source;
        own.camera = static_cast<std::uint16_t>(&c - cameras_.data() + 1);
        f.order.from_frame = c.faults->next_frame();
        return handle(f, own);
    });
}

CommandStatus CommandDispatch::order(const FaultCommand& f, const CommandSource& source) {
    if (!f.clear_all && !refusal_of(f.order).empty()) return CommandStatus::kBadArgument;
    return for_cameras(source.camera, [&](const CommandedCamera& c) {
        f.clear_all ? c.faults->clear_all() : c.faults->order(f.order);
        return CommandStatus::kAccepted;
    });
}

}  // namespace hilcam
