#include "render/sky/saturn_rings.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/sky/body_photometry.h"
#include "render/vocabulary/units.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

TEST(SaturnRings, ThePhaseFunctionHasAMeanOfOne) {
    double sum = 0;
    constexpr int kSteps = 1000;
    for (int i = 0; i < kSteps; ++i) {
        const double a = kPi * (i + 0.5) / kSteps;
        sum += 0.5 * SaturnRings::phase_function(a) * std::sin(a) * kPi / kSteps;
    }
    EXPECT_NEAR(sum, 1, 1e-4);
}

TEST(SaturnRings, TheyAreWhereTheFactSheetHasThem) {
    EXPECT_EQ(SaturnRings::depth(70000e3), 0);
    EXPECT_GT(SaturnRings::depth(80000e3), 0.03);
    EXPECT_LT(SaturnRings::depth(80000e3), 0.35);
    EXPECT_GT(SaturnRings::depth(105000e3), 0.9);
    EXPECT_LE(SaturnRings::depth(122150e3), 0.10);
    EXPECT_GT(SaturnRings::depth(130000e3), 0.4);
    EXPECT_EQ(SaturnRings::depth(133589e3), 0);
    EXPECT_EQ(SaturnRings::depth(137000e3), 0);
}

// Light that is scattered once comes back and goes through as a thin layer's does: tau / 4 mu per unit of w P / pi.
TEST(SaturnRings, AThinRingScattersAsItsDepthSays) {
    const SaturnRings rings(SpectralGrid({0.54, 0.56}));
    const Vec3d in_gap{121000e3, 0, 0};  // Cassini's division
    const double tau = SaturnRings::depth(121000e3);
    const double mu0 = 0.9, mu = 0.8;
    const Vec3d sun{std::sqrt(1 - mu0 * mu0), 0, mu0};
    for (const double side : {1.0, -1.0}) {
        const Vec3d viewer{std::sqrt(1 - mu * mu), 0, side * mu};
        const SaturnRings::Look look = rings.look(in_gap, 0, viewer, sun);
        const double p = SaturnRings::phase_function(std::acos(dot(viewer, sun)));
        const double thin =
            SaturnRings::brightness(std::acos(dot(viewer, sun))) * 0.3 * p / (4 * kPi) * tau / mu;
        EXPECT_NEAR(static_cast<double>(look.radiance_sr[0]) / thin, 1, 0.16) << side;  // tau / mu is 0.14
        EXPECT_LT(static_cast<double>(look.radiance_sr[0]), thin);
        EXPECT_NEAR(static_cast<double>(look.transmittance), std::exp(-tau / mu), 1e-6);
    }
}

TEST(SaturnRings, TheyAreDrawnAndDimWhatIsBehindAndLieInSaturnsShadow) {
    Stage s;
    s.camera(64, 0.2);
    s.scene.body(BodyId::kSaturn) = {
        true, BodyLook(BodyId::kSaturn, default_body(BodyId::kSaturn), s.grid), {}};
    s.world.bodies[BodyId::kSaturn].world_m = {0, 0, 1e9};
    // The pole leans 30 degrees to the camera: axes x right, y and z turned about x.
    const double a = 30 * kDegree_rad;
    s.world.bodies[BodyId::kSaturn].fixed_from_world = {
        {1, 0, 0}, {0, std::sin(a), std::cos(a)}, {0, -std::cos(a), -std::sin(a)}};
    s.sun({0.0, -0.2, -1});
    const auto at = [&](double x_m, double y_m) {
        // Pixels per metre at 1e9 m: 160 px per unit tangent.
        return static_cast<double>(
            s.radiance.row(static_cast<int>(32 + 160e-9 * y_m))[static_cast<std::size_t>(32 + 160e-9 * x_m)]);
    };
    s.render();
    EXPECT_EQ(at(110000e3, 0), 0);
    s.scene.body(BodyId::kSaturn).rings = true;
    s.render();
    EXPECT_GT(at(110000e3, 0), 1);
    EXPECT_GT(at(-110000e3, 0), 1);
    // The Sun behind the left shoulder: the right ansa's far side is in shadow only behind the globe.
    s.sun({-1, 0, -0.05});
    s.render();
    EXPECT_LT(at(90000e3, 0), 0.02 * at(-90000e3, 0));
}

}  // namespace
}  // namespace hilcam
