// Trajectory from an orbit ephemeris.

#include <algorithm>
#include <optional>

#include "emulator/motion/ephemeris.h"
#include "emulator/motion/reference_axes.h"
#include "emulator/motion/trajectories.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

std::string lower(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

// Returns the centre with that name. The barycentres of Mercury, Venus and Mars are within a metre of their
// centres.
OrbitCenter center_named(const OemSegment& segment, const std::string& file) {
    std::string name = lower(ccsds_word(segment.center_name));
    if (name == "sun") return {std::nullopt};
    for (const char* planet : {"mercury", "venus", "mars"})
        if (name == std::string(planet) + " barycenter") name = planet;
    const auto at = std::find(kBodyNames.begin(), kBodyNames.end(), name);
    if (at == kBodyNames.end())
        throw InputError(
            file + ":" + std::to_string(segment.line) + ": CENTER_NAME: found " +
            in_quotes(segment.center_name) +
            "; accepted: SUN, MERCURY, VENUS, EARTH, MOON, MARS, JUPITER, SATURN, URANUS, NEPTUNE "
            "(of barycentres those of MERCURY, VENUS, MARS)");
    const OrbitCenter center{static_cast<BodyId>(at - kBodyNames.begin())};
    if (is_of_the_earth(segment.frame) && center != OrbitCenter{})
        throw InputError(file + ":" + std::to_string(segment.line) + ": CENTER_NAME: found " +
                         in_quotes(segment.center_name) + "; accepted: EARTH, by its REF_FRAME");
    return center;
}

class OemTrajectory final : public Trajectory {
  public:
    OemTrajectory(std::vector<OemSegment> segments, const std::string& name)
        : segments_(std::move(segments)), name_(name) {
        for (const OemSegment& s : segments_)
            places_.push_back({center_named(s, name), resting_axes(s.frame, s.frame_epoch)});
    }

    MotionValidity validity(TimeTai time) const override { return validity_of(segments_, time); }
    StateVector at(const MotionContext& context) const override {
        const OemSegment& segment = segment_of(segments_, context.frame.time());
        const Place& place = places_[static_cast<std::size_t>(&segment - segments_.data())];
        const StateVector s = in_icrf(segment, place, context);
        const StateVector center = context.frame.center(place.center);
        return {center.position_m + s.position_m, center.velocity_m_s + s.velocity_m_s};
    }
    std::string name() const override { return name_; }

  private:
    // The centre of each segment, and its axes if they do not turn.
    struct Place {
        OrbitCenter center;
        std::optional<Mat3d> icrf_from_axes;
    };
    std::vector<OemSegment> segments_;
    std::vector<Place> places_;
    std::string name_;

    StateVector in_icrf(const OemSegment& segment, const Place& place, const MotionContext& context) const {
        const StateVector s = interpolate_state(segment, context.frame.time());
        if (place.icrf_from_axes)
            return {*place.icrf_from_axes * s.position_m, *place.icrf_from_axes * s.velocity_m_s};
        if (segment.frame == CcsdsFrame::kIcrf) return s;
        return world_state({{}, axes_of_date(segment.frame, context.frame)}, s);
    }
};

}  // namespace

std::unique_ptr<Trajectory> make_oem(std::vector<OemSegment> segments, const std::string& name) {
    return std::make_unique<OemTrajectory>(std::move(segments), name);
}

}  // namespace hilcam
