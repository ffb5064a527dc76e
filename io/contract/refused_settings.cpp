#include "io/contract/refused_settings.h"

#include <cstdint>

#include "render/vocabulary/plain_number.h"

namespace hilcam {
namespace {

template <class Value>
std::string outside(const char* name, const std::optional<Value>& value, double least, double most) {
    if (!value) return {};
    const auto found = static_cast<double>(*value);
    if (found >= least && found <= most) return {};
    return std::string(name) + ": found " + plain(found) + "; accepted: " + plain(least) + " to " +
           plain(most);
}

std::string no_binning(const char* name, const std::optional<std::int64_t>& value, std::int64_t most) {
    if (!value || (*value >= 1 && *value <= most && (*value & (*value - 1)) == 0)) return {};
    return std::string(name) + ": found " + std::to_string(*value) + "; accepted: 1, 2, 4 and so on up to " +
           std::to_string(most);
}

std::string lacking(const char* name, const std::optional<bool>& wanted, bool there) {
    return wanted.value_or(false) && !there ? std::string(name) + ": this camera does not have it" : "";
}

// The camera sets it itself.
std::string own(const char* name, bool asked, bool is_own, const char* why) {
    if (!asked || !is_own) return {};
    return std::string(name) + ": the camera sets it itself (" + why + ")";
}

// TriggerWidth needs a pulse, and an exposure that the camera leaves to it.
std::string no_trigger_width(const SettingsChange& c, CameraSettings now, const CameraLimits& l) {
    apply(c, now);
    if (now.exposure_mode != ExposureMode::kTriggerWidth) return {};
    const std::string key = "exposure_mode: trigger_width ";
    if (l.lockstep) return key + "needs real time, and this is lockstep";
    if (l.exposure_is_own) return key + "needs an exposure that the camera does not set itself";
    if (now.automatic_exposure) return key + "and automatic_exposure exclude each other";
    if (now.trigger_activation == TriggerActivation::kAnyEdge)
        return key + "and trigger_activation any_edge exclude each other";
    if (is_level(now.trigger_activation))
        return key + "and trigger_activation level_high and level_low exclude each other";
    return {};
}

std::string no_level(const SettingsChange& c, const CameraLimits& l) {
    if (!c.trigger_activation || !is_level(*c.trigger_activation) || l.has_trigger_levels()) return {};
    return "trigger_activation: level_high and level_low need real time, and this is lockstep";
}

}  // namespace

std::string refusal_of(const SettingsChange& c, const CameraSettings& now, const CameraLimits& l) {
    constexpr const char* kFixed = "a sequence, or a line-scan shutter";
    const bool automatic = c.automatic_exposure.value_or(now.automatic_exposure);
    for (std::string line : {
             own("exposure_s", c.exposure_s.has_value(), l.exposure_is_own, kFixed),
             own("exposure_s", c.exposure_s.has_value(), automatic, "automatic_exposure is on"),
             own("gain_db", c.gain_db.has_value(), l.gain_is_own, kFixed),
             own("frame_rate_hz", c.frame_rate_hz.has_value(), l.frame_rate_is_own, kFixed),
             outside("exposure_s", c.exposure_s, l.min_exposure_s, l.max_exposure_s),
             outside("gain_db", c.gain_db, l.min_gain_db, l.max_gain_db),
             outside("black_level_dn", c.black_level_dn, 0, l.max_black_level_dn),
             outside("frame_rate_hz", c.frame_rate_hz, l.min_frame_rate_hz, l.max_frame_rate_hz),
             outside("trigger_delay_s", c.trigger_delay_s, 0, l.max_trigger_delay_s),
             outside("burst_frames", c.burst_frames, 1, static_cast<double>(l.max_burst_frames)),
             no_binning("binning_x", c.binning_x, l.max_binning),
             no_binning("binning_y", c.binning_y, l.max_binning),
             lacking("automatic_exposure", c.automatic_exposure, l.has_automatic_exposure),
             lacking("reverse_x", c.reverse_x, l.reversible),
             lacking("reverse_y", c.reverse_y, l.reversible),
             outside("trigger_divider", c.trigger_divider, 1, static_cast<double>(l.max_trigger_divider)),
             no_trigger_width(c, now, l),
             no_level(c, l),
             c.trigger_overlap == TriggerOverlap::kOff && !l.can_wait_for_readout()
                 ? std::string("trigger_overlap: a line scanner's frames join without a gap")
                 : std::string(),
         })
        if (!line.empty()) return line;
    if (c.triggered && l.lockstep) return "triggered: in lockstep each 'expose' takes a frame, and stays so";
    return "the camera cannot set this now";
}

}  // namespace hilcam
