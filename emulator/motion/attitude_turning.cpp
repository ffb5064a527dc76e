// Attitudes that are simple in some frame: constant, turning, or through keyframes.

#include "emulator/motion/attitude_laws.h"

namespace hilcam {
namespace {

class Turning final : public AttitudeLaw {
  public:
    Turning(const PlacedFrame& frame, const AttitudeState& at_start, TimeTai start)
        : frame_(frame), at_start_(at_start), start_(start) {}

    AttitudeState at(const MotionContext& context, const OwnMotion&) const override {
        const double dt_s = static_cast<double>(context.frame.time() - start_) * kSecondsPerNs;
        const Quat turn = from_rotation_vector(dt_s * at_start_.rate_body_rad_s);
        return world_attitude(axes_of(frame_, context).axes,
                              {normalized(at_start_.world_from_body * turn), at_start_.rate_body_rad_s});
    }
    std::vector<MotionNeed> needs() const override { return frame_.needs(); }
    std::string name() const override { return "attitude"; }

  private:
    PlacedFrame frame_;
    AttitudeState at_start_;
    TimeTai start_;
};

class Keyframed final : public AttitudeLaw {
  public:
    Keyframed(const PlacedFrame& frame, Keyframes keyframes)
        : frame_(frame), keyframes_(std::move(keyframes)) {}

    AttitudeState at(const MotionContext& context, const OwnMotion&) const override {
        return world_attitude(axes_of(frame_, context).axes, keyframes_.attitude_at(context.frame.time()));
    }
    std::vector<MotionNeed> needs() const override { return frame_.needs(); }
    std::string name() const override { return "keyframes"; }

  private:
    PlacedFrame frame_;
    Keyframes keyframes_;
};

}  // namespace

std::unique_ptr<AttitudeLaw> make_turning(const PlacedFrame& frame, const AttitudeState& at_start,
                                          TimeTai start) {
    return std::make_unique<Turning>(frame, at_start, start);
}

std::unique_ptr<AttitudeLaw> make_keyframed_attitude(const PlacedFrame& frame, Keyframes keyframes) {
    return std::make_unique<Keyframed>(frame, std::move(keyframes));
}

}  // namespace hilcam
