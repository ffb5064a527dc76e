// Kepler's orbit about a centre in the world.

#include "emulator/motion/trajectories.h"

namespace hilcam {
namespace {

class KeplerTrajectory final : public Trajectory {
  public:
    KeplerTrajectory(const OrbitCenter& center, const KeplerElements& elements, TimeTai epoch)
        : center_(center), orbit_(elements, gravity_m3_s2(center)), epoch_(epoch) {}

    StateVector at(const MotionContext& context) const override {
        const StateVector center = context.frame.center(center_);
        const StateVector s = orbit_.at(static_cast<double>(context.frame.time() - epoch_) * kSecondsPerNs);
        return {center.position_m + s.position_m, center.velocity_m_s + s.velocity_m_s};
    }
    std::string name() const override { return "Kepler's orbit"; }

  private:
    OrbitCenter center_;
    KeplerOrbit orbit_;
    TimeTai epoch_;
};

}  // namespace

std::unique_ptr<Trajectory> make_kepler(const OrbitCenter& center, const KeplerElements& elements,
                                        TimeTai epoch) {
    return std::make_unique<KeplerTrajectory>(center, elements, epoch);
}

}  // namespace hilcam
