#include "emulator/recording/recording_text.h"

#include <array>
#include <nlohmann/json.hpp>

#include "io/commands/command_payload.h"
#include "io/contract/frame_flags.h"
#include "render/vocabulary/overloaded.h"

namespace hilcam {
namespace {

// Keys are written in the order in which they are added.
using OrderedJson = nlohmann::ordered_json;

// Names in the order of ClockCommand::Action; the reader has checked the value.
constexpr std::array kClockActions = {"ask", "scale", "pause", "resume", "step"};

OrderedJson list_of(const Vec3d& v) { return {v.x, v.y, v.z}; }

// Works for any two numbers, because values in a file need not be times.
double seconds_between(std::int64_t from_ns, std::int64_t to_ns) {
    const std::uint64_t ns = static_cast<std::uint64_t>(to_ns) - static_cast<std::uint64_t>(from_ns);
    return 1e-9 * static_cast<double>(static_cast<std::int64_t>(ns));
}
double seconds_since(std::int64_t ns, const RecordingHeader& header) {
    return seconds_between(header.monotonic_start_ns, ns);
}
double seconds_since(TimeTai time, const RecordingHeader& header) {
    return seconds_between(header.start.ns, time.ns);
}

template <class T>
void add(OrderedJson& out, const char* key, const std::optional<T>& value) {
    if (value) out[key] = *value;
}

void add_command(OrderedJson& out, const Command& command, const RecordingHeader& header) {
    out["command"] = name_of_function(function_of(command));
    std::visit(Overloaded{
                   [&](const PoseCommand& p) {
                       const Motion& m = p.motion;
                       const Quat& q = m.pose.world_from_body;
                       out["object"] = p.object;
                       out["at_s"] = seconds_since(m.time, header);
                       out["position_m"] = list_of(m.pose.position_world_m);
                       out["attitude_wxyz"] = {q.w, q.x, q.y, q.z};
                       out["velocity_m_s"] = list_of(m.velocity_world_m_s);
                       out["rate_rad_s"] = list_of(m.rate_body_rad_s);
                   },
                   [&](const JointCommand& j) {
                       out["object"] = j.object;
                       out["joint"] = j.joint;
                       out["at_s"] = seconds_since(j.time, header);
                       out["angle_rad"] = j.angle_rad;
                       out["rate_rad_s"] = j.rate_rad_s;
                   },
                   [&](const LampCommand& l) {
                       out["lamp"] = l.lamp;
                       out["at_s"] = seconds_since(l.time, header);
                       out["level"] = l.level;
                   },
                   [&](const SettingsCommand& s) {
                       add(out, "exposure_s", s.exposure_s);
                       add(out, "gain_db", s.gain_db);
                       add(out, "frame_rate_hz", s.frame_rate_hz);
                   },
                   [&](const ExposeCommand& e) {
                       out["frames"] = e.frames;
                       if (e.time.ns != 0) out["at_s"] = seconds_since(e.time, header);
                   },
                   [&](const FaultCommand& f) {
                       out["fault"] = f.clear_all ? std::string_view("clear") : name_of(f.order.kind);
                       if (f.clear_all) return;
                       out["rate"] = f.order.rate;
                       out["value"] = f.order.value;
                       out["from_frame"] = f.order.from_frame;
                       out["frames"] = f.order.frames;
                       out["duration_s"] = f.order.duration_s;
                   },
                   [&](const TriggerModeCommand& m) {
                       out["triggered"] = m.triggered;
                       out["burst_frames"] = m.burst_frames;
                   },
                   [&](const ClockCommand& c) {
                       out["action"] = kClockActions.at(static_cast<std::size_t>(c.action));
                       if (c.action == ClockCommand::Action::kScale) out["scale"] = c.scale;
                       if (c.action == ClockCommand::Action::kStep)
                           out["step_s"] = seconds_between(0, c.step_ns);
                   },
                   // These commands have only a name.
                   [](const OneOf<StartCommand, StopCommand, PingCommand, SubscribeCommand> auto&) {},
               },
               command);
}

void add_change(OrderedJson& out, const SettingsChange& c) {
    visit_settings([&](std::string_view name, auto, auto wish) {
        if (!(c.*wish)) return;
        const auto value = *(c.*wish);
        if constexpr (std::is_enum_v<decltype(value)>)
            out[std::string(name)] = static_cast<int>(value);
        else
            out[std::string(name)] = value;
    });
}

OrderedJson text_of(const RecordedFrame& f, const RecordingHeader& header) {
    const FrameUse& u = f.use;
    OrderedJson out = {{"record", "frame"},
                       {"camera", f.camera},
                       {"frame", u.id},
                       {"begin_s", seconds_since(u.begin_ns, header)},
                       {"middle_s", seconds_since(u.exposure_mid, header)},
                       {"shown_s", seconds_since(u.shown_at, header)},
                       {"exposure_s", u.exposure_s},
                       {"gain_db", u.gain_db},
                       {"black_level_dn", u.black_level_dn},
                       {"binning", {u.binning_x, u.binning_y}},
                       {"quality_level", u.quality_level},
                       {"trigger_sequence", u.trigger_sequence},
                       {"skipped", u.skipped}};
    if (u.sequencer_set >= 0) out["sequencer_set"] = u.sequencer_set;
    if (u.late) out["late"] = true;
    if (u.shutter_closed) out["shutter_closed"] = true;
    if (u.test_pattern != TestPattern::kOff) out["test_pattern"] = static_cast<int>(u.test_pattern);
    if (u.reverse_x) out["reverse_x"] = true;
    if (u.reverse_y) out["reverse_y"] = true;
    if (u.faults != 0) out["faults"] = names_of_bits(u.faults);
    return out;
}

OrderedJson text_of(const RecordedCommand& c, const RecordingHeader& header) {
    OrderedJson out = {{"record", "command"},
                       {"number", c.number},
                       {"arrival_s", seconds_since(c.source.arrival_monotonic_ns, header)},
                       {"sequence", c.source.sequence}};
    if (c.source.camera != 0) out["camera"] = c.source.camera;
    if (c.source.event != 0) out["event"] = c.source.event - 1;  // from 0, as in the scenario's list
    add_command(out, c.command, header);
    return out;
}
OrderedJson text_of(const RecordedChange& c, const RecordingHeader& header) {
    OrderedJson out = {
        {"record", "settings"}, {"camera", c.camera}, {"at_s", seconds_since(c.monotonic_ns, header)}};
    add_change(out, c.change);
    return out;
}
OrderedJson text_of(const RecordedTrigger& t, const RecordingHeader& header) {
    return {{"record", "trigger"},
            {"camera", t.camera},
            {"at_s", seconds_since(t.monotonic_ns, header)},
            {"source", static_cast<int>(t.order.source)},
            {"frames", t.order.frames},
            {"sequence", t.order.sequence},
            {"taken", t.result == TriggerResult::kTaken}};
}
OrderedJson text_of(const RecordedShown& s, const RecordingHeader&) {
    return {{"record", "shown"}, {"camera", s.camera}, {"thing", s.thing}, {"number", s.number}};
}
OrderedJson text_of(const RecordedLoss& l, const RecordingHeader&) {
    return {{"record", "loss"}, {"records", l.records}};
}
OrderedJson text_of(const RecordedEnd& e, const RecordingHeader& header) {
    return {{"record", "end"}, {"at_s", seconds_since(e.monotonic_ns, header)}};
}

}  // namespace

void list_recording(RecordingReader& recording, const std::function<void(const std::string&)>& line) {
    const RecordingHeader& h = recording.header();
    // Replaces invalid UTF-8, which names in a scenario may contain.
    const auto show = [&](const OrderedJson& value) {
        line(value.dump(-1, ' ', false, OrderedJson::error_handler_t::replace));
    };
    show({{"record", "header"},
          {"program", h.program},
          {"build", h.build},
          {"processor", h.processor},
          {"start_utc", format_utc(h.start)},
          {"cameras", h.cameras},
          {"lockstep", h.lockstep},
          {"scenario", h.scenario}});
    recording.pass_losses();
    Record record;
    while (recording.next(record)) show(std::visit([&](const auto& r) { return text_of(r, h); }, record));
    show({{"record", "file"},
          {"whole", recording.end() == RecordingEnd::kClean},
          {"bytes", recording.offset()},
          {"text", recording.end_text()}});
}

}  // namespace hilcam
