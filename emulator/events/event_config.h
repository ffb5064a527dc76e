#pragma once
// The section `events:` of a scenario: what happens by itself, when, and what it does (docs/events.md).
//
// An event carries out commands in the words of `hilcam send`, so that benches, scripts and scenarios share
// one vocabulary. The additional word `end` ends the run.

#include <cstdint>
#include <string>
#include <vector>

#include "io/contract/command.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

// Limits on a quantity in the previous frame. If several limits are given, all must hold.
struct EventLimitsConfig {
    double below = 0, above = 0;
    bool has_below = false, has_above = false;

    bool given() const { return has_below || has_above; }
};

enum class EventLight { kAny, kLit, kEclipsed };

struct EventConditionConfig {
    std::string object;  // name of an object, a body, or the Sun
    EventLimitsConfig distance_m, off_boresight_rad, sun_off_boresight_rad, phase_rad;
    EventLight light = EventLight::kAny;
    double margin_m = 0, margin_rad = 0;

    bool needs_object() const { return distance_m.given() || off_boresight_rad.given() || phase_rad.given(); }
    bool given() const {
        return needs_object() || sun_off_boresight_rad.given() || light != EventLight::kAny;
    }
};
Fields fields(EventConditionConfig& condition);
void validate(const EventConditionConfig& condition);

struct EventConfig {
    std::string name;
    double at_s = 0;
    std::string at_utc;
    std::int64_t at_frame = 0;
    std::string after;
    double delay_s = 0;
    EventConditionConfig when;
    bool has_at_s = false, has_at_utc = false, has_at_frame = false, has_after = false, has_when = false;
    double every_s = 0;
    std::int64_t times = 1;  // 0: unlimited
    double again_after_s = 0;
    std::int64_t camera = 0;
    std::vector<std::string> actions;
};
Fields fields(EventConfig& event);
void validate(const EventConfig& event);

// An event's actions as commands.
struct EventActions {
    std::vector<Command> commands;
    bool ends_run = false;
    bool takes_picture() const;
    bool only_switches_lamps() const;
};
// Throws InputError.
EventActions actions_of(const EventConfig& event);

}  // namespace hilcam
