// Trajectory of a satellite from its element set.

#include <algorithm>
#include <cmath>

#include "emulator/motion/trajectories.h"
#include "io/orbits/sgp4.h"
#include "render/sky/earth_frames.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr double kMinute_ns = 60e9;

class TleTrajectory final : public Trajectory {
  public:
    TleTrajectory(const ElementSet& tle, double valid_s)
        : sgp4_({tle.epoch_days_1950, tle.inclination_rad, tle.node_rad, tle.eccentricity, tle.perigee_rad,
                 tle.mean_anomaly_rad, tle.mean_motion_rad_min, tle.bstar_per_er}),
          epoch_(tle.epoch),
          name_(tle.where) {
        if (!works(0))
            throw InputError(name_ + ": the elements of satellite " + tle.satellite +
                             " are no orbit above the ground at their epoch");
        first_ = epoch_ + -std::llround(limit(-1, valid_s / 60) * kMinute_ns);
        last_ = epoch_ + std::llround(limit(1, valid_s / 60) * kMinute_ns);
    }

    MotionValidity validity(TimeTai time) const override { return validity_of(time, first_, last_); }
    StateVector at(const MotionContext& context) const override {
        StateVector teme;
        const double minutes = static_cast<double>(context.frame.time() - epoch_) / kMinute_ns;
        // limit() makes sure that this does not happen
        if (sgp4_.at(minutes, teme) != Sgp4Status::kOk) sgp4_.at(0, teme);
        const Mat3d icrf = context.frame.icrf_from_teme();
        const StateVector earth = context.frame.center({});
        return {earth.position_m + icrf * teme.position_m, earth.velocity_m_s + icrf * teme.velocity_m_s};
    }
    std::string name() const override { return name_; }

  private:
    Sgp4 sgp4_;
    TimeTai epoch_, first_, last_;
    std::string name_;

    bool works(double minutes) const {
        StateVector state;
        return sgp4_.at(minutes, state) == Sgp4Status::kOk;
    }
    // Finds how far from epoch the theory works, in minutes: in steps of five, then by bisection.
    double limit(int direction, double most) const {
        constexpr double kStep = 5;
        double good = 0, bad = 0;
        while (good < most && bad == 0) {
            const double next = std::min(good + kStep, most);
            (works(direction * next) ? good : bad) = next;
        }
        while (bad - good > 1e-6) {
            const double middle = 0.5 * (good + bad);
            (works(direction * middle) ? good : bad) = middle;
        }
        return good;
    }
};

}  // namespace

std::unique_ptr<Trajectory> make_tle(const ElementSet& tle, double valid_s) {
    return std::make_unique<TleTrajectory>(tle, valid_s);
}

}  // namespace hilcam
