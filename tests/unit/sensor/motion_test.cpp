#include "sensor/motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

double sinc_squared(double x) {
    const double a = kPi * x;
    return a == 0 ? 1 : std::sin(a) * std::sin(a) / (a * a);
}

// Integral of the table's density times a weight of f, Simpson's rule with 2 million steps.
template <class Weight>
double integral_arcsec2(const Table& psd, const Weight& weight) {
    double sum = 0;
    for (std::size_t i = 1; i < psd.x.size(); ++i) {
        constexpr int kSteps = 2'000'000;
        const double width = psd.x[i] - psd.x[i - 1], step = width / kSteps;
        for (int k = 0; k <= kSteps; ++k) {
            const double u = static_cast<double>(k) / kSteps, f = psd.x[i - 1] + u * width;
            const double s = psd.y[i - 1] + u * (psd.y[i] - psd.y[i - 1]);
            sum += (k == 0 || k == kSteps ? 1 : k % 2 ? 4 : 2) * step / 3 * s * weight(f);
        }
    }
    return sum;
}

JitterConfig vibration() {
    JitterConfig c;
    c.psd_arcsec2_hz = {{0.1, 1, 10, 40, 50, 300}, {40, 8, 0.5, 0.5, 3, 0.001}};
    return c;
}

constexpr double kArcsecond2_rad2 = kArcsecond_rad * kArcsecond_rad;

TEST(Jitter, BlurIsTheIntegralOverTheDensity) {
    for (const double exposure_s : {1e-4, 0.01, 0.3, 10.0}) {
        const double expected = integral_arcsec2(vibration().psd_arcsec2_hz,
                                                 [&](double f) { return 1 - sinc_squared(f * exposure_s); });
        // Simpson's error at 3000 periods in a piece of 2e6 steps: (2 pi 3000 / 2e6)^4 / 180 of the part that
        // oscillates, 4e-11; at 1e-4 s the reference loses eight digits in 1 - sinc^2.
        EXPECT_NEAR(jitter_blur_rad2(vibration(), exposure_s) / kArcsecond2_rad2, expected, 1e-7 * expected)
            << exposure_s;
    }
    EXPECT_EQ(jitter_blur_rad2(vibration(), 0), 0);
    EXPECT_EQ(jitter_blur_rad2({}, 1), 0);
}

TEST(Jitter, ALongExposureBlursAllAndAShortOneTheSlopeOnly) {
    const double all = integral_arcsec2(vibration().psd_arcsec2_hz, [](double) { return 1; });
    // sinc^2 averages to 1 / (2 (pi f T)^2): below 2e-9 of S at 1e4 s from 0.1 Hz on.
    EXPECT_NEAR(jitter_blur_rad2(vibration(), 1e4) / kArcsecond2_rad2, all, 1e-6 * all);
    // T to 0: S (pi f T)^2 / 3, with (pi f T)^2 < 1e-6 the next term is 2/15 of that.
    const double slope = integral_arcsec2(vibration().psd_arcsec2_hz, [](double f) { return f * f; });
    const double t = 1e-6;
    EXPECT_NEAR(jitter_blur_rad2(vibration(), t) / kArcsecond2_rad2, kPi * kPi * t * t / 3 * slope,
                1e-6 * kPi * kPi * t * t / 3 * slope);
}

// Sum over seeds of the squared displacement at one instant, both axes, over the variance expected.
double chi_square(const JitterConfig& drawn, double expected_rad2, double exposure_s, int seeds) {
    double sum = 0;
    for (int seed = 0; seed < seeds; ++seed) {
        const PointingJitter jitter(drawn, static_cast<std::uint64_t>(seed), {});
        const Vec2d a = jitter.at({123'456'789'012}, exposure_s);
        sum += (a.x * a.x + a.y * a.y) / expected_rad2;
    }
    return sum;
}

TEST(Jitter, DisplacementOfExposuresHasTheRestOfTheVariance) {
    constexpr int kSeeds = 4000;
    // 2 x 4000 unit Gaussians (to 1/128 in kurtosis): standard deviation sqrt(2 x 8000) = 126.5. Four
    // exposures at 4.5 sigma: a right one is refused once in 37,000 runs of other seeds.
    const double tolerance = 4.5 * std::sqrt(2.0 * 2 * kSeeds);
    for (const double exposure_s : {1e-4, 0.01, 0.1, 1.0}) {
        const double expected =
            kArcsecond2_rad2 * integral_arcsec2(vibration().psd_arcsec2_hz,
                                                [&](double f) { return sinc_squared(f * exposure_s); });
        EXPECT_NEAR(chi_square(vibration(), expected, exposure_s, kSeeds), 2 * kSeeds, tolerance)
            << exposure_s;
        // A density that is a tenth too high is found out: 800 more than expected.
        JitterConfig wrong = vibration();
        for (double& s : wrong.psd_arcsec2_hz.y) s *= 1.1;
        EXPECT_GT(chi_square(wrong, expected, exposure_s, kSeeds), 2 * kSeeds + tolerance) << exposure_s;
    }
}

TEST(Jitter, DisplacementFollowsTheDensityInTime) {
    // One line at 5 Hz: half a period later the picture is where it was not, a period later where it was.
    JitterConfig line;
    line.psd_arcsec2_hz = {{4.999, 5.001}, {100, 100}};
    const PointingJitter jitter(line, 7, {1'000});
    const Vec2d now = jitter.at({1'000 + 300'000'000}, 0), half = jitter.at({1'000 + 400'000'000}, 0),
                whole = jitter.at({1'000 + 500'000'000}, 0);
    // Phases within 2 pi 0.001 Hz x 0.2 s of each other.
    const double scale = kArcsecond_rad * std::sqrt(0.2);
    EXPECT_NEAR(half.x, -now.x, 0.005 * scale);
    EXPECT_NEAR(whole.x, now.x, 0.005 * scale);
    EXPECT_GT(std::abs(now.x) + std::abs(now.y), 0.05 * scale);
    // A whole number of periods in an exposure leaves nothing.
    EXPECT_NEAR(jitter.at({1'000 + 300'000'000}, 0.2).x, 0, 0.001 * scale);
}

TEST(Jitter, TurnsTheCameraAboutItsOwnAxes) {
    const PointingJitter jitter(vibration(), 3, {});
    const Pose camera{{1, 2, 3}, from_rotation_vector({0.3, -0.8, 1.1})};
    const Vec2d angle = jitter.at({5}, 0.01);
    const Pose moved = jitter.applied(camera, {5}, 0.01);
    // Where a direction fixed in the world goes in the camera's axes: d - omega x d, on the boresight
    // (-omega_y, +omega_x, 1).
    const Vec3d before = to_matrix(camera.world_from_body) * Vec3d{0, 0, 1};
    const Vec3d after = transposed(to_matrix(moved.world_from_body)) * before;
    EXPECT_NEAR(after.x, -angle.y, 1e-9);
    EXPECT_NEAR(after.y, angle.x, 1e-9);
    EXPECT_EQ(moved.position_world_m, camera.position_world_m);
    EXPECT_EQ(PointingJitter().applied(camera, {5}, 0.01).world_from_body.x, camera.world_from_body.x);
}

TEST(Jitter, ADensityNeedsABand) {
    JitterConfig c;
    EXPECT_NO_THROW(validate(c));
    c.psd_arcsec2_hz = {{1}, {2}};
    EXPECT_THROW(validate(c), InputError);
}

}  // namespace
}  // namespace hilcam
