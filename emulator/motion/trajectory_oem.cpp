// An ephemeris of states.

#include <algorithm>

#include "emulator/motion/ephemeris.h"
#include "emulator/motion/trajectories.h"
#include "render/sky/earth_frames.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

std::string lower(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

// The centre of that name. The barycentres of Mercury, Venus and Mars lie within a metre of them.
OrbitCenter center_named(const OemSegment& segment, const std::string& file) {
    std::string name = lower(segment.center_name);
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
    const bool earth_only = segment.frame == CcsdsFrame::kEarthFixed || segment.frame == CcsdsFrame::kTeme;
    if (earth_only && center != OrbitCenter{})
        throw InputError(file + ":" + std::to_string(segment.line) + ": CENTER_NAME: found " +
                         in_quotes(segment.center_name) + "; accepted: EARTH, by its REF_FRAME");
    return center;
}

StateVector turned(const Mat3d& icrf_from_frame, const StateVector& s) {
    return {icrf_from_frame * s.position_m, icrf_from_frame * s.velocity_m_s};
}

class OemTrajectory final : public Trajectory {
  public:
    OemTrajectory(std::vector<OemSegment> segments, const std::string& name)
        : segments_(std::move(segments)), name_(name), icrf_from_eme2000_(icrf_from_eme2000()) {
        for (const OemSegment& s : segments_) centers_.push_back(center_named(s, name));
    }

    MotionValidity validity(TimeTai time) const override { return validity_of(segments_, time); }
    StateVector at(const MotionContext& context) const override {
        const OemSegment& segment = segment_of(segments_, context.frame.time());
        const StateVector s = in_icrf(segment, context);
        const StateVector center =
            context.frame.center(centers_[static_cast<std::size_t>(&segment - segments_.data())]);
        return {center.position_m + s.position_m, center.velocity_m_s + s.velocity_m_s};
    }
    std::string name() const override { return name_; }

  private:
    std::vector<OemSegment> segments_;
    std::vector<OrbitCenter> centers_;  // centre of each segment
    std::string name_;
    Mat3d icrf_from_eme2000_;

    StateVector in_icrf(const OemSegment& segment, const MotionContext& context) const {
        const TimeTai time = context.frame.time();
        const StateVector s = interpolate_state(segment, time);
        switch (segment.frame) {
            case CcsdsFrame::kEme2000:
                return turned(icrf_from_eme2000_, s);
            case CcsdsFrame::kTeme:
                return turned(context.frame.icrf_from_teme(), s);
            case CcsdsFrame::kEarthFixed:
                return world_state({{}, context.frame.body_fixed(BodyId::kEarth)}, s);
            case CcsdsFrame::kIcrf:
            case CcsdsFrame::kLvlh:  // the reader takes none of these
            case CcsdsFrame::kRtn:
            case CcsdsFrame::kBody:
                break;
        }
        return s;
    }
};

}  // namespace

std::unique_ptr<Trajectory> make_oem(std::vector<OemSegment> segments, const std::string& name) {
    return std::make_unique<OemTrajectory>(std::move(segments), name);
}

}  // namespace hilcam
