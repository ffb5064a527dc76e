// When a satellite enters the Earth's umbra and leaves it, against Orekit.

#include <gtest/gtest.h>

#include "emulator/motion/kepler_orbit.h"
#include "render/background/background.h"
#include "render/vocabulary/time_system.h"
#include "render/vocabulary/units.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

// Orekit 10's test of its eclipse detector (EclipseDetectorTest.testPolar): gravity, epoch and state; the
// orbit is turned over both poles with its other elements kept.
constexpr double kOrekitGravity = 3.9860047e14;
const StateVector kState{{-6142438.668, 3492467.560, -25767.25680}, {505.8479685, 942.7809215, 7435.922231}};
TimeTai epoch() { return from_calendar({1969, 7, 28, 4, 0, 0}, TimeSystem::kTt).value(); }

double angle_about(Vec3d axis, Vec3d from, Vec3d to) {
    return std::atan2(dot(axis, cross(from, to)), dot(from, to));
}

// Vallado, 4th ed., 2013, algorithm 9.
KeplerElements elements_of(const StateVector& s, double gravity) {
    const double r = length(s.position_m), v2 = dot(s.velocity_m_s, s.velocity_m_s);
    const Vec3d momentum = cross(s.position_m, s.velocity_m_s), normal = normalized(momentum);
    const Vec3d node = normalized(cross(Vec3d{0, 0, 1}, momentum));
    const Vec3d eccentricity = (1 / gravity) * cross(s.velocity_m_s, momentum) - (1 / r) * s.position_m;
    const double e = length(eccentricity);
    const double true_anomaly = angle_about(normal, eccentricity, s.position_m);
    return {1 / (2 / r - v2 / gravity),
            e,
            std::acos(normal.z),
            std::atan2(node.y, node.x),
            angle_about(normal, node, eccentricity),
            mean_anomaly(true_anomaly, e)};
}

class PolarOrbit {
  public:
    PolarOrbit() {
        stage_.earth(0.3);
        KeplerElements elements = elements_of(kState, kOrekitGravity);
        elements.inclination_rad = kPi / 2;
        orbit_.emplace(elements, kOrekitGravity);
    }
    // Whether any of the Sun's light arrives there.
    bool lit(double seconds) const {
        WorldSnapshot world;
        world.time = epoch() + std::llround(seconds * 1e9);
        world.bodies = bodies_at(world.time, {});
        const Vec3d place_m = orbit_->at(seconds).position_m;
        world.camera.position_world_m = place_m;
        Background background(stage_.scene.bodies, nullptr, nullptr, stage_.scene.sun_irradiance_1au_w_m2_um,
                              true, stage_.grid);
        background.place(world, place_m, 1e-4);
        return background.sun_irradiance_w_m2_um()[0] > 0;
    }
    // Between an instant that is lit and one that is not.
    double edge(double light_s, double dark_s) const {
        EXPECT_TRUE(lit(light_s));
        EXPECT_FALSE(lit(dark_s));
        while (std::abs(light_s - dark_s) > 1e-3) {
            const double middle = 0.5 * (light_s + dark_s);
            (lit(middle) ? light_s : dark_s) = middle;
        }
        return light_s;
    }

  private:
    Stage stage_;
    std::optional<KeplerOrbit> orbit_;
};

// The satellite is 3040 km behind the limb and comes nearer to the shadow's axis at some 3.2 km/s. Our Sun is
// where it is seen, 20.5 arcsec from where Orekit's is: 0.10 s. Its disk is a set of samples, the last of
// which disappears up to 3 % of its radius before the edge does: 0.13 s. The flattening of the Earth, by the
// same source, makes 5.7 s and 6.4 s, and the penumbra takes 9 s.
TEST(Eclipse, TheUmbraBeginsAndEndsWhenOrekitSaysSo) {
    const PolarOrbit orbit;
    constexpr double kTolerance_s = 0.23;
    EXPECT_NEAR(orbit.edge(2200, 2400), 2280.427, kTolerance_s);
    EXPECT_NEAR(orbit.edge(4400, 4200), 4310.742, kTolerance_s);
    EXPECT_NEAR(orbit.edge(8100, 8300), 8194.978, kTolerance_s);
    EXPECT_NEAR(orbit.edge(10300, 10100), 10225.704, kTolerance_s);
    EXPECT_NEAR(orbit.edge(14000, 14200), 14109.530, kTolerance_s);
}

}  // namespace
}  // namespace hilcam
