#include "sensor/expected_noise.h"

#include <gtest/gtest.h>

#include "tests/support/cameras.h"
#include "tests/support/statistics.h"

namespace hilcam {
namespace {

CameraModel camera_with_noise() {
    CameraModel c = camera_64();
    c.gain_dn_e = 0.25;
    c.bits = 16;
    c.offset_dn = 200;
    c.read_noise_e = 6;
    c.dark_current_e_s = 4000;
    c.dsnu_e = 5;
    c.prnu_fraction = 0.02;
    c.cos_power = 0;
    return c;
}

// Frames of even light: their variance over the pixels is what was foretold.
TEST(ExpectedNoise, IsThatOfTheSensorsOwnFrames) {
    for (const double electrons : {0.0, 500.0, 20'000.0}) {
        Bench bench(camera_with_noise());
        const Exposure exposure{.exposure_s = 0.01};
        const PixelNoise noise = ExpectedNoise(bench.camera, bench.grid, bench.sampling).of(exposure);
        Spectrum radiance;
        radiance[0] = static_cast<float>(electrons / (per_radiance(bench.camera, bench.grid) * 0.01));
        EXPECT_NEAR(static_cast<double>(noise.electrons(radiance, 1)), electrons, 1e-3 * electrons + 1e-6);
        bench.fill(radiance[0]);
        bench.expose(exposure);
        bench.chain.digitise(bench.electrons, exposure, {3, 1}, bench.frame);
        const Moments seen = moments_of(bench.frame.all());
        const double gain = bench.camera.gain_dn_e;
        // A variance of 64 x 64 pixels scatters by sqrt(2 / 4095), 2.2 %; five times that.
        const auto foretold_e2 = static_cast<double>(noise.variance_e2(static_cast<float>(electrons)));
        EXPECT_NEAR(seen.variance / (gain * gain) / foretold_e2, 1, 0.11) << electrons;
        // Each part of it is seen: without the dark current's shot noise (40 e-^2) or DSNU (25), of 103, the
        // dark frame's would be off by a quarter and more.
        EXPECT_NEAR(noise.variance_e2(0), 36 + 16.0 / 12 + 40 + 25, 1e-3);
    }
}

TEST(ExpectedNoise, TheMostSensitiveFilterCountsAndPartsOfAPixelAverage) {
    CameraModel c = camera_with_noise();
    const SpectralGrid grid({0.5, 0.6});
    const Exposure exposure{.exposure_s = 0.01};
    const PixelNoise grey = ExpectedNoise(c, grid, {8, 1, 3}).of(exposure);
    EXPECT_FLOAT_EQ(grey.averaged, 9);
    c.color_filter.pattern = "RG GB";
    for (const auto& [name, transmission] : {std::pair{"R", 0.2}, std::pair{"G", 0.6}, std::pair{"B", 0.1}})
        c.color_filter.filters.push_back({name, Curve::constant(transmission)});
    const PixelNoise mosaic = ExpectedNoise(c, grid, {8, 1, 1}).of(exposure);
    EXPECT_NEAR(mosaic.electrons_per_radiance[0] / grey.electrons_per_radiance[0], 0.6, 1e-5);
    // Four charges read together: a quarter of the reading's variance for each.
    Exposure binned = exposure;
    binned.binning_x = binned.binning_y = 2;
    const PixelNoise quarter = ExpectedNoise(c, grid, {8, 1, 1}).of(binned);
    EXPECT_NEAR(mosaic.dark_variance_e2 - quarter.dark_variance_e2, 0.75 * (36 + 16.0 / 12), 1e-3);
}

}  // namespace
}  // namespace hilcam
