#include "emulator/events/event_config.h"

#include <algorithm>
#include <array>

#include "emulator/send/command_words.h"
#include "render/sky/motion_bounds.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/overloaded.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/time.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr std::string_view kEnd = "end";
constexpr Range kDistance_m{0, 1e16}, kAngle_deg{0, 180};

void add_limits(Fields& list, const std::string& word, const std::string& unit, EventLimitsConfig& limits,
                double si_per_unit, Range range, const std::string& meaning) {
    list.push_back(optional(
        number(word + "_below_" + unit, limits.below, si_per_unit, range, meaning + " is below this"),
        limits.has_below));
    list.push_back(optional(
        number(word + "_above_" + unit, limits.above, si_per_unit, range, meaning + " is above this"),
        limits.has_above));
}

void check_limits(const EventLimitsConfig& limits, const std::string& word) {
    if (limits.has_below && limits.has_above && !(limits.above < limits.below))
        throw InputError("'" + word + "': nothing is above the one limit and below the other");
}

}  // namespace

Fields fields(EventConditionConfig& c) {
    Fields list = {text("object", c.object, "subject of the condition: an object's name, a body's, or sun")};
    add_limits(list, "distance", "m", c.distance_m, 1, kDistance_m,
               "true while the distance from the camera to the object's origin");
    add_limits(list, "off_boresight", "deg", c.off_boresight_rad, kDegree_rad, kAngle_deg,
               "true while the angle from the camera's +z to the object");
    add_limits(list, "phase", "deg", c.phase_rad, kDegree_rad, kAngle_deg,
               "true while the phase angle (Sun - object - camera)");
    add_limits(list, "sun_off_boresight", "deg", c.sun_off_boresight_rad, kDegree_rad, kAngle_deg,
               "true while the angle from the camera's +z to the Sun");
    list.push_back(choice("light", c.light, {"any", "lit", "eclipsed"},
                          "condition on sunlight. lit: no body hides the Sun's centre from the object; "
                          "eclipsed: a body hides it. Without an object: from the camera"));
    list.push_back(number("margin_m", c.margin_m, 1, kDistance_m,
                          "hysteresis: distance beyond the limit at which a true condition becomes false"));
    list.push_back(number("margin_deg", c.margin_rad, kDegree_rad, kAngle_deg,
                          "hysteresis: angle beyond the limit at which a true condition becomes false"));
    return list;
}

void validate(const EventConditionConfig& c) {
    if (!c.given())
        throw InputError(
            "a condition names no quantity; accepted: distance_below_m, off_boresight_below_deg, "
            "phase_below_deg, sun_off_boresight_below_deg, the same with _above_, light");
    if (c.needs_object() && c.object.empty())
        throw InputError("a condition on distance, off_boresight or phase needs 'object'");
    check_limits(c.distance_m, "distance");
    check_limits(c.off_boresight_rad, "off_boresight");
    check_limits(c.phase_rad, "phase");
    check_limits(c.sun_off_boresight_rad, "sun_off_boresight");
}

Fields fields(EventConfig& e) {
    return {
        text("name", e.name, "name of the event, for 'after' and the log"),
        optional(number("at_s", e.at_s, 1, {0, 1e9}, "simulated time of the event from the start"),
                 e.has_at_s),
        optional(text("at_utc", e.at_utc, "simulated time of the event, in UTC"), e.has_at_utc),
        optional(integer("at_frame", e.at_frame, {1, 9e15},
                         "number of the first camera's frame at which the event happens"),
                 e.has_at_frame),
        optional(
            text("after", e.after, "name of another event; this event happens after each of its occurrences"),
            e.has_after),
        number("delay_s", e.delay_s, 1, {0, 1e9}, "delay after the event named by 'after'"),
        optional(section("when", e.when,
                         "condition; the event happens when it becomes true in a frame of the first camera"),
                 e.has_when),
        number("every_s", e.every_s, 1, {0, 1e9}, "period of repetition of an event with 'at_s' or 'at_utc'"),
        integer("times", e.times, {0, 9e15}, "largest number of times that the event happens; 0: no limit"),
        number("again_after_s", e.again_after_s, 1, {0, 1e9},
               "shortest time between two occurrences of an event with 'when'"),
        integer("camera", e.camera, {0, 65535},
                "camera that receives the settings, faults and triggers; 0: every camera"),
        required(
            texts("do", e.actions, "commands in the words of 'hilcam send', or end, which ends the run")),
    };
}

void validate(const EventConfig& e) {
    const std::array given = {e.has_at_s, e.has_at_utc, e.has_at_frame, e.has_after, e.has_when};
    const auto count = std::count(given.begin(), given.end(), true);
    if (count != 1)
        throw InputError("an event has one of 'at_s', 'at_utc', 'at_frame', 'after' and 'when'; found " +
                         std::to_string(count));
    if (e.has_at_utc) at_key("at_utc", [&] { parse_utc(e.at_utc); });
    if (e.every_s > 0 && !e.has_at_s && !e.has_at_utc)
        throw InputError("'every_s' goes with 'at_s' or 'at_utc'; found neither");
    if (e.delay_s > 0 && !e.has_after) throw InputError("'delay_s' goes with 'after'; found it without");
    if (e.again_after_s > 0 && !e.has_when)
        throw InputError("'again_after_s' goes with 'when'; found it without");
    actions_of(e);
}

bool EventActions::only_switches_lamps() const {
    return !ends_run && std::all_of(commands.begin(), commands.end(),
                                    [](const Command& c) { return std::holds_alternative<LampCommand>(c); });
}

bool EventActions::takes_picture() const {
    return std::any_of(commands.begin(), commands.end(),
                       [](const Command& c) { return std::holds_alternative<ExposeCommand>(c); });
}

namespace {

// Returns why an event cannot give this command; empty: it can.
std::string_view refusal_of(const Command& command) {
    using namespace std::string_view_literals;
    return std::visit(
        Overloaded{
            [](const SettingsCommand& s) {
                return s.exposure_s || s.gain_db || s.frame_rate_hz ? ""sv : "names no setting"sv;
            },
            [](const OneOf<PingCommand, SubscribeCommand> auto&) { return "does nothing to a camera"sv; },
            [](const PoseCommand& p) {
                return is_possible(p.motion) ? ""sv : "exceeds the limits of motion (docs/motion.md)"sv;
            },
            [](const JointCommand& j) {
                return is_possible_turn_of_joint(j.angle_rad, j.rate_rad_s)
                           ? ""sv
                           : "exceeds the limits of motion (docs/motion.md)"sv;
            },
            [](const OneOf<StartCommand, StopCommand, FaultCommand, ExposeCommand, TriggerModeCommand,
                           ClockCommand, LampCommand> auto&) { return ""sv; },
        },
        command);
}

}  // namespace

EventActions actions_of(const EventConfig& e) {
    EventActions out;
    if (e.actions.empty()) throw KeyError("do", "found an empty list; accepted: one command or more");
    for (const std::string& words : e.actions) {
        if (words == kEnd) {
            out.ends_run = true;
            continue;
        }
        Command command;
        try {
            command = command_of_words(words);
        } catch (const std::exception& error) {
            throw KeyError("do", "found " + in_quotes(words) + ": " + harmless(error.what()));
        }
        if (const std::string_view reason = refusal_of(command); !reason.empty())
            throw KeyError("do", "found " + in_quotes(words) + ": " + std::string(reason));
        out.commands.push_back(command);
    }
    return out;
}

}  // namespace hilcam
