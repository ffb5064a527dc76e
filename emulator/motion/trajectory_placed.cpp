// Trajectories that are simple in some frame: at rest, through keyframes, drifting.

#include "emulator/motion/relative_motion.h"
#include "emulator/motion/trajectories.h"

namespace hilcam {
namespace {

double seconds_since(TimeTai start, TimeTai time) {
    return static_cast<double>(time - start) * kSecondsPerNs;
}

// F: TimeTai -> StateVector in the frame.
template <class F>
class Placed final : public Trajectory {
  public:
    Placed(const PlacedFrame& frame, F&& in_frame, const char* name)
        : frame_(frame), in_frame_(std::move(in_frame)), name_(name) {}

    StateVector at(const MotionContext& context) const override {
        return world_state(axes_of(frame_, context), in_frame_(context.frame.time()));
    }
    // A thing that flies with another on its orbit falls almost like it.
    std::optional<Vec3d> acceleration(const MotionContext& context) const override {
        if (frame_.follows_thing()) return {};
        // The motion is at most cubic, so central differences of the velocity are exact.
        constexpr std::int64_t kHalf_ns = 10'000;
        const TimeTai time = context.frame.time();
        const StateVector s = in_frame_(time);
        const Vec3d change =
            (in_frame_(time + kHalf_ns).velocity_m_s - in_frame_(time + -kHalf_ns).velocity_m_s) /
            (2 * kHalf_ns * kSecondsPerNs);
        const TurningAxes axes = axes_of(frame_, context).axes;
        const Vec3d w = axes.rate_rad_s;
        return axes.icrf_from_axes * change + 2.0 * cross(w, axes.icrf_from_axes * s.velocity_m_s) +
               cross(w, cross(w, axes.icrf_from_axes * s.position_m));
    }
    std::vector<MotionNeed> needs() const override { return frame_.needs(); }
    std::string name() const override { return name_; }

  private:
    PlacedFrame frame_;
    F in_frame_;
    const char* name_;
};

template <class F>
std::unique_ptr<Trajectory> placed(const PlacedFrame& frame, F&& in_frame, const char* name) {
    return std::make_unique<Placed<std::decay_t<F>>>(frame, std::forward<F>(in_frame), name);
}

}  // namespace

std::unique_ptr<Trajectory> make_fixed(const PlacedFrame& frame, const StateVector& at_start, TimeTai start) {
    return placed(
        frame,
        [at_start, start](TimeTai time) {
            return StateVector{at_start.position_m + seconds_since(start, time) * at_start.velocity_m_s,
                               at_start.velocity_m_s};
        },
        "fixed position");
}

std::unique_ptr<Trajectory> make_keyframed(const PlacedFrame& frame, Keyframes keyframes) {
    return placed(
        frame, [keyframes = std::move(keyframes)](TimeTai time) { return keyframes.state_at(time); },
        "keyframes");
}

std::unique_ptr<Trajectory> make_drifting(const PlacedFrame& lvlh, const StateVector& at_start,
                                          double mean_motion_rad_s, TimeTai start) {
    return placed(
        lvlh, [=](TimeTai time) { return drifted(at_start, mean_motion_rad_s, seconds_since(start, time)); },
        "relative motion");
}

}  // namespace hilcam
