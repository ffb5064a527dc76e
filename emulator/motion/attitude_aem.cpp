// Attitude from an attitude ephemeris.

#include "emulator/motion/attitude_laws.h"
#include "emulator/motion/ephemeris.h"
#include "emulator/motion/reference_axes.h"

namespace hilcam {
namespace {

class AemLaw final : public AttitudeLaw {
  public:
    AemLaw(std::vector<AemSegment> segments, const OrbitCenter& center, const std::string& name)
        : segments_(std::move(segments)),
          center_(center),
          name_(name),
          eme2000_{*resting_axes(CcsdsFrame::kEme2000, {}), {}} {}

    MotionValidity validity(TimeTai time) const override { return validity_of(segments_, time); }
    AttitudeState at(const MotionContext& context, const OwnMotion& self) const override {
        const AemSegment& segment = segment_of(segments_, context.frame.time());
        const ReferenceAttitude a = interpolate_attitude(segment, context.frame.time());
        return world_attitude(reference_axes(segment.reference, context, self),
                              {a.reference_from_body, a.rate_body_rad_s});
    }
    std::string name() const override { return name_; }

  private:
    std::vector<AemSegment> segments_;
    OrbitCenter center_;
    std::string name_;
    TurningAxes eme2000_;

    TurningAxes reference_axes(CcsdsFrame reference, const MotionContext& context,
                               const OwnMotion& self) const {
        const auto lvlh = [&] {
            TurningAxes axes = lvlh_axes(about_center(context, self.state, center_));
            if (self.stands) axes.rate_rad_s = {};
            return axes;
        };
        switch (reference) {
            case CcsdsFrame::kEme2000:
                return eme2000_;
            case CcsdsFrame::kTeme:
            case CcsdsFrame::kTod:
            case CcsdsFrame::kMod:
            case CcsdsFrame::kGtod:
            case CcsdsFrame::kEarthFixed:
                return axes_of_date(reference, context.frame);
            case CcsdsFrame::kLvlh:
                return lvlh();
            case CcsdsFrame::kRtn: {
                // In LVLH's axes: x outward, y along the motion, z along the normal.
                TurningAxes axes = lvlh();
                axes.icrf_from_axes = axes.icrf_from_axes * Mat3d{{0, 1, 0}, {0, 0, -1}, {-1, 0, 0}};
                return axes;
            }
            case CcsdsFrame::kIcrf:
            case CcsdsFrame::kBody:  // the reader rejects these
                break;
        }
        return {};
    }
};

}  // namespace

std::unique_ptr<AttitudeLaw> make_aem(std::vector<AemSegment> segments, const OrbitCenter& center,
                                      const std::string& name) {
    return std::make_unique<AemLaw>(std::move(segments), center, name);
}

}  // namespace hilcam
