#include "sensor/stray/outside_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/vocabulary/units.h"
#include "sensor/optics.h"
#include "tests/support/cameras.h"

namespace hilcam {
namespace {

constexpr float kIrradiance_w_m2_um = 1800;

SideLight light_at(double angle_rad, double azimuth_rad = 0) {
    SideLight light;
    light.camera_dir = to_float(Vec3d{std::sin(angle_rad) * std::cos(azimuth_rad),
                                      std::sin(angle_rad) * std::sin(azimuth_rad), std::cos(angle_rad)});
    light.irradiance_w_m2_um[0] = kIrradiance_w_m2_um;
    return light;
}

ElectronImage& expose(Bench& bench, std::span<const SideLight> lights) {
    bench.chain.expose(bench.radiance, {}, {.exposure_s = 1e-3}, bench.electrons, lights);
    return bench.electrons;
}

// Electrons that the whole aperture takes in 1 ms.
double all_of(const Bench& bench) {
    return static_cast<double>(electrons_per_s_per_irradiance(bench.camera, bench.grid)[0]) * 1e-3 *
           static_cast<double>(kIrradiance_w_m2_um);
}

// Photo-electrons of PST x E on a pixel: no lens is in them but its curve.
TEST(OutsideLight, AMeasuredTransmittanceIsGivenBackAtItsAngles) {
    CameraModel c = camera_64();
    c.transmission = Curve::constant(0.8);
    c.outside_light.emplace();
    c.outside_light->transmittance = {{20, 30, 60}, {1e-4, 1e-5, 1e-8}};
    Bench bench(c);
    // Photons on a pixel, 1 ms, over the bin's photon energies: QE 0.5.
    CameraModel bare = c;
    bare.transmission = Curve::constant(1);
    const double photo = static_cast<double>(electrons_per_s_per_irradiance(bare, bench.grid)[0]) /
                         aperture_area_m2(bare) * c.pitch_m * c.pitch_m * 1e-3 *
                         static_cast<double>(kIrradiance_w_m2_um);
    for (const auto& [angle_deg, pst] : {std::pair{20.0, 1e-4},
                                         {25.0, std::sqrt(1e-4 * 1e-5)},
                                         {30.0, 1e-5},
                                         {45.0, std::sqrt(1e-5 * 1e-8)},
                                         {60.0, 1e-8}}) {
        // A rounding of the direction must not end it.
        const SideLight light = light_at((angle_deg - 2e-5) * kDegree_rad, 0.7);
        const ElectronImage& e = expose(bench, {&light, 1});
        EXPECT_NEAR(at(e, 5, 50) / (photo * pst), 1, 1e-4) << angle_deg;
        EXPECT_EQ(at(e, 5, 50), at(e, 60, 3));
    }
    const SideLight beyond = light_at(61 * kDegree_rad);
    EXPECT_EQ(sum(expose(bench, {&beyond, 1})), 0);
    // Two sources add.
    const SideLight both[] = {light_at(30 * kDegree_rad), light_at(30 * kDegree_rad, 2)};
    EXPECT_NEAR(at(expose(bench, both), 32, 32) / (2 * photo * 1e-5), 1, 1e-3);
}

// Without a curve the halo goes on: r / (2 pi (r^2 + x^2)^1.5), x the difference of direction cosines times f.
TEST(OutsideLight, TheHaloGoesOnBeyondTheField) {
    CameraModel c = gaussian_camera(0.5);
    c.stray_light.veiling_glare_fraction = 0.02, c.stray_light.glare_radius_px = 5;
    c.outside_light.emplace();
    Bench bench(c);
    const double f = c.focal_length_m / c.pitch_m;
    for (const double angle_deg : {1.0, 5.0, 40.0}) {
        const double angle = angle_deg * kDegree_rad;
        const SideLight light = light_at(angle);
        const ElectronImage& e = expose(bench, {&light, 1});
        for (const int px : {0, 32, 63}) {
            const double here = std::sin(std::atan((px + 0.5 - 32) / f));
            const double x = f * (std::sin(angle) - here);
            const double halo = 0.02 * 5 / (2 * kPi * std::pow(25 + x * x, 1.5));
            EXPECT_NEAR(at(e, px, 32) / (all_of(bench) * std::cos(angle) * halo), 1, 4e-3) << angle_deg;
        }
    }
}

TEST(OutsideLight, NothingComesFromBehind) {
    CameraModel c = gaussian_camera(0.5);
    c.stray_light.veiling_glare_fraction = 0.02, c.stray_light.glare_radius_px = 5;
    c.outside_light.emplace();
    Bench bench(c);
    for (const double angle_deg : {91.0, 135.0, 179.0}) {
        const SideLight light = light_at(angle_deg * kDegree_rad);
        EXPECT_EQ(sum(expose(bench, {&light, 1})), 0) << angle_deg;
    }
}

// Two equal disks, from an angle of 0 on, overlap by (2 / pi) (acos x - x sqrt(1 - x^2)) with x the distance over the
// diameter.
TEST(OutsideLight, ABaffleShadesAsDisksOverlap) {
    const double end = 30 * kDegree_rad;
    for (const double x : {0.1, 0.5, 0.9})
        EXPECT_NEAR(lit_share(std::atan(x * std::tan(end)), 0, end),
                    2 / kPi * (std::acos(x) - x * std::sqrt(1 - x * x)), 1e-9);
    EXPECT_EQ(lit_share(4.99 * kDegree_rad, 5 * kDegree_rad, end), 1);
    EXPECT_NEAR(lit_share(5.01 * kDegree_rad, 5 * kDegree_rad, end), 1, 1e-3);
    EXPECT_EQ(lit_share(end, 5 * kDegree_rad, end), 0);
    EXPECT_NEAR(lit_share(29.99 * kDegree_rad, 5 * kDegree_rad, end), 0, 1e-3);
    double before = 1;
    for (int deg = 0; deg <= 30; ++deg) {
        const double now = lit_share(deg * kDegree_rad, 5 * kDegree_rad, end);
        EXPECT_LE(now, before) << deg;
        before = now;
    }
}

TEST(OutsideLight, BehindTheBaffleTheLeakIsLeft) {
    CameraModel c = gaussian_camera(0.5);
    c.stray_light.veiling_glare_fraction = 0.02, c.stray_light.glare_radius_px = 5;
    c.outside_light.emplace();
    const SideLight light = light_at(40 * kDegree_rad);
    Bench open(c);
    c.outside_light->baffle_rad = 35 * kDegree_rad;
    Bench closed(c);
    c.outside_light->baffle_leak = 0.01;
    Bench leaking(c);
    EXPECT_GT(sum(expose(open, {&light, 1})), 0);
    EXPECT_EQ(sum(expose(closed, {&light, 1})), 0);
    EXPECT_NEAR(sum(expose(leaking, {&light, 1})) / sum(expose(open, {&light, 1})), 0.01, 1e-6);
}

// A ring of 0.3 to 1 of the radius defocus / 2 N about its place, with its share of the light.
TEST(OutsideLight, AGhostHasItsLightItsPlaceAndItsSize) {
    CameraModel c = gaussian_camera(0.5);
    c.width_px = c.height_px = 256;
    c.central_obscuration_ratio = 0.3;
    c.outside_light.emplace();
    const double radius_px = 20;
    c.outside_light->ghosts = {
        {5 * kDegree_rad, 15 * kDegree_rad, 1e-3, -0.03, radius_px * 2 * c.f_number * c.pitch_m}};
    Bench bench(c);
    const double angle = 10 * kDegree_rad;
    const SideLight light = light_at(angle, 0.5);
    const ElectronImage& e = expose(bench, {&light, 1});
    double all = 0, x_sum = 0, y_sum = 0, square = 0;
    const double reach = -0.03 * c.focal_length_m / c.pitch_m * std::tan(angle);
    const double cx = 128 + reach * std::cos(0.5), cy = 128 + reach * std::sin(0.5);
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 256; ++x) {
            all += at(e, x, y), x_sum += at(e, x, y) * (x + 0.5), y_sum += at(e, x, y) * (y + 0.5);
            square += at(e, x, y) * (std::pow(x + 0.5 - cx, 2) + std::pow(y + 0.5 - cy, 2));
        }
    // The wings of light beside the field are in it too: diffraction alone, 1e-6 of the light.
    EXPECT_NEAR(all / (all_of(bench) * std::cos(angle) * 1e-3), 1, 5e-3);
    EXPECT_NEAR(x_sum / all, cx, 0.2);
    EXPECT_NEAR(y_sum / all, cy, 0.2);
    // Mean square radius of a ring: (R^2 + r^2) / 2.
    EXPECT_NEAR(square / all / (0.5 * radius_px * radius_px * (1 + 0.09)), 1, 0.02);
    for (const double outside_deg : {4.0, 16.0}) {
        const SideLight none = light_at(outside_deg * kDegree_rad);
        EXPECT_LT(sum(expose(bench, {&none, 1})), 0.02 * all) << outside_deg;
    }
}

TEST(OutsideLight, ACameraWithoutItIgnoresWhatIsBeside) {
    Bench bench(camera_64());
    const SideLight light = light_at(10 * kDegree_rad);
    EXPECT_EQ(sum(expose(bench, {&light, 1})), 0);
}

}  // namespace
}  // namespace hilcam
