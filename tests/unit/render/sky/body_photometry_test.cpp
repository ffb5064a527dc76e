#include "render/sky/body_photometry.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/sky/bodies.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

// Point and disk of a body have the same light, whatever the law: the sum of its radiance over the disk
// against disk_albedo. The Moon at 40 degrees: V = -12.73 + 0.026 x 40 + 4e-9 x 40^4 (Krisciunas & Schaefer
// 1991).
TEST(PlanetshineSource, DiskSumsUpToTheMagnitude) {
    const SpectralGrid grid({0.545, 0.555});
    for (const BodyId id : {BodyId::kMoon, BodyId::kMars, BodyId::kJupiter}) {
        const BodyLook look(id, default_body(id), grid);
        for (const double phase : {0.0, 40 * kDegree_rad}) {
            const Vec3d sun{std::sin(phase), 0, std::cos(phase)};
            double sum = 0;
            constexpr int kAcross = 1000;
            for (int i = 0; i < kAcross; ++i)
                for (int j = 0; j < kAcross; ++j) {
                    const double x = 2 * (i + 0.5) / kAcross - 1, y = 2 * (j + 0.5) / kAcross - 1;
                    if (x * x + y * y >= 1) continue;
                    const Vec3d n{x, y, std::sqrt(1 - x * x - y * y)};
                    sum += static_cast<double>(look.reflectance_sr(static_cast<float>(dot(n, sun)),
                                                                   static_cast<float>(n.z),
                                                                   static_cast<float>(sun.z))[0]) *
                           4 / (kAcross * kAcross);
                }
            EXPECT_NEAR(sum / static_cast<double>(look.disk_albedo(phase)[0]), 1, 2e-3)
                << static_cast<int>(id);
            // From the equator the outline is an ellipse.
            const Figure& figure = kFigures[index_of(id)];
            const double outline_au2 = figure.equatorial_radius_m * figure.polar_radius_m /
                                       (kAstronomicalUnit_m * kAstronomicalUnit_m);
            EXPECT_NEAR(-2.5 * std::log10(sum * outline_au2) - 26.76, magnitude_v_1au(id, phase), 0.005);
        }
    }
    EXPECT_NEAR(magnitude_v_1au(BodyId::kMoon, 0) + 5 * std::log10(384400e3 / kAstronomicalUnit_m), -12.73,
                0.01);
}

BodyConfig hapke_moon() {
    BodyConfig config = default_body(BodyId::kMoon);
    config.law = SurfaceLaw::kHapke;
    return config;
}

// By squares of the disk, where the table goes by chords.
TEST(PlanetshineSource, HapkesDiskIsTheSumOfItsElements) {
    const SpectralGrid grid({0.6, 0.68});
    const BodyLook look(BodyId::kMoon, hapke_moon(), grid);
    for (const double phase_deg : {0.0, 5.0, 40.0, 90.0, 135.0}) {
        const double g = phase_deg * kDegree_rad;
        const Vec3d sun{std::sin(g), 0, std::cos(g)};
        constexpr int kAcross = 700;
        double sum = 0;
        for (int j = 0; j < kAcross; ++j)
            for (int i = 0; i < kAcross; ++i) {
                const double x = (2 * i + 1.0) / kAcross - 1, y = (2 * j + 1.0) / kAcross - 1;
                if (x * x + y * y >= 1) continue;
                const Vec3d n{x, y, std::sqrt(1 - x * x - y * y)};
                sum += static_cast<double>(look.reflectance_sr(static_cast<float>(dot(n, sun)),
                                                               static_cast<float>(n.z),
                                                               static_cast<float>(std::cos(g)))[0]);
            }
        sum *= 4.0 / (kAcross * kAcross);
        EXPECT_NEAR(sum / static_cast<double>(look.disk_albedo(g)[0]), 1, 6e-3) << phase_deg;
    }
}

// Sato et al. 2014 with these medians: I/F of 0.098 at 30 deg incidence and phase, 0.046 at 60, worked out from
// Hapke's formulas by another program.
TEST(PlanetshineSource, TheMoonsReflectanceFactorIsThatOfItsParameters) {
    const SpectralGrid grid({0.638, 0.648});
    const BodyLook look(BodyId::kMoon, hapke_moon(), grid);
    const auto radiance_factor = [&](double i_deg) {
        const auto cosine = static_cast<float>(std::cos(i_deg * kDegree_rad));
        return kPi * static_cast<double>(look.reflectance_sr(cosine, 1, cosine)[0]);
    };
    EXPECT_NEAR(radiance_factor(30), 0.09784, 2e-4);
    EXPECT_NEAR(radiance_factor(60), 0.04582, 1e-4);
    // The surge: full over quarter Moon is some ten times.
    EXPECT_GT(look.disk_albedo(2 * kDegree_rad)[0] / look.disk_albedo(90 * kDegree_rad)[0], 8);
}

TEST(PlanetshineSource, NothingIsBrighterThanItsBound) {
    const SpectralGrid grid({0.6, 0.7});
    const BodyLook look(BodyId::kMoon, hapke_moon(), grid);
    const float most = look.max_sr()[0];
    for (int g_deg = 0; g_deg <= 150; g_deg += 5)
        for (int lon_deg = g_deg - 89; lon_deg < 90; lon_deg += 2) {
            const double lon = lon_deg * kDegree_rad, g = g_deg * kDegree_rad;
            EXPECT_LE(
                look.reflectance_sr(static_cast<float>(std::cos(lon - g)), static_cast<float>(std::cos(lon)),
                                    static_cast<float>(std::cos(g)))[0],
                1.02f * most)
                << g_deg << " " << lon_deg;
        }
}

TEST(PlanetshineSource, RefusesWhatContradictsItself) {
    const SpectralGrid grid({0.6, 0.7});
    BodyConfig mars = default_body(BodyId::kMars);
    mars.law = SurfaceLaw::kHapke;
    EXPECT_THROW(BodyLook(BodyId::kMars, mars, grid), InputError);
    mars.has_albedo = true;
    mars.albedo = Curve::constant(0.5);
    EXPECT_NO_THROW(BodyLook(BodyId::kMars, mars, grid));
    BodyConfig moon = hapke_moon();
    moon.has_measured = true;
    EXPECT_THROW(validate(moon), InputError);
    moon = hapke_moon();
    moon.height_zero_m = -10000;
    EXPECT_THROW(validate(moon), InputError);
}

// The Moon's night side, which faces a full Earth: the Earth as a Lambert disk, the Moon's law at its phase.
TEST(PlanetshineSource, TheEarthShinesOnTheMoonsNight) {
    Stage s;
    s.geometry.focal_length_px = 8000;
    const double moon_m = 3.9e8, earth_m = -2e7;
    s.earth(0.3);
    s.scene.body(BodyId::kMoon) = {true, BodyLook(BodyId::kMoon, hapke_moon(), s.grid), {}};
    s.scene.body(BodyId::kMoon).planetshine = true;
    s.world.bodies[BodyId::kMoon].world_m = {0, 0, moon_m};
    s.world.bodies[BodyId::kEarth].world_m = {0, 1.5e7, earth_m};
    s.sun({0.3, 0, 1});  // behind the Moon
    s.render();
    const double seen = static_cast<double>(s.middle());
    const Vec3d to_earth = Vec3d{0, 1.5e7, earth_m} - Vec3d{0, 0, moon_m};
    const double sun_moon = std::acos(dot(normalized(to_earth), -1 * normalized(Vec3d{0.3, 0, 1})));
    const double phase = sun_moon;  // the Sun is far away
    const double light = static_cast<double>(kSun_w_m2_um) * 0.3 * 2 / 3 * lambert_phase(phase) *
                         std::pow(kEarthEquatorialRadius_m / length(to_earth), 2);
    const BodyLook look(BodyId::kMoon, hapke_moon(), s.grid);
    const double cosine = dot(normalized(to_earth), Vec3d{0, 0, -1});
    const double expected = light * static_cast<double>(look.reflectance_sr(static_cast<float>(cosine), 1,
                                                                            static_cast<float>(cosine))[0]);
    EXPECT_GT(expected, 1e-4);
    EXPECT_NEAR(seen / expected, 1, 0.02);
    s.scene.body(BodyId::kMoon).planetshine = false;
    s.render();
    EXPECT_EQ(s.middle(), 0);
}

}  // namespace
}  // namespace hilcam
