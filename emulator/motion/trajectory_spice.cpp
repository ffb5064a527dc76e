// Trajectory of an object in SPICE kernels.

#include "emulator/motion/spice_coverage.h"
#include "emulator/motion/trajectories.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

class SpiceTrajectory final : public Trajectory {
  public:
    SpiceTrajectory(std::shared_ptr<SpiceKernels> kernels, const SpicePlace& place, const std::string& name)
        : kernels_(std::move(kernels)), place_(place), name_("spice: " + name) {
        kernels_->bodies.require(place.object, name_);
        if (kernels_->bodies.has(place.about)) kernels_->bodies.require(place.about, name_);
        coverage_ = SpiceCoverage(kernels_->bodies.coverage(place.object, place.about), kernels_->set.time);
        if (coverage_.empty())
            throw InputError(
                name_ + ": the kernels never say where " + std::to_string(place.object) + " is about " +
                std::to_string(place.about) +
                "; accepted: kernels that lead from both to one centre, as a planet's ephemeris (DE) does");
    }

    MotionValidity validity(TimeTai time) const override { return coverage_.validity(time); }
    StateVector at(const MotionContext& context) const override {
        StateVector s;
        if (!kernels_->bodies.state(place_.object, place_.about, coverage_.et_s(context.frame.time()), s))
            return kUnknownState;
        if (!place_.center) return s;
        const StateVector center = context.frame.center(*place_.center);
        return {center.position_m + s.position_m, center.velocity_m_s + s.velocity_m_s};
    }
    std::string name() const override { return name_; }

  private:
    std::shared_ptr<SpiceKernels> kernels_;
    SpicePlace place_;
    std::string name_;
    SpiceCoverage coverage_;
};

}  // namespace

std::unique_ptr<Trajectory> make_spice_place(std::shared_ptr<SpiceKernels> kernels, const SpicePlace& place,
                                             const std::string& name) {
    return std::make_unique<SpiceTrajectory>(std::move(kernels), place, name);
}

}  // namespace hilcam
