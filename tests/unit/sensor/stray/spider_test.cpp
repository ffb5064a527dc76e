#include "sensor/stray/spider.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/vocabulary/units.h"
#include "sensor/optics.h"
#include "tests/support/cameras.h"

namespace hilcam {
namespace {

CameraModel spider_camera() {
    CameraModel c = camera_64();
    c.width_px = c.height_px = 256;
    c.focal_length_m = 0.5, c.f_number = 8;
    c.central_obscuration_ratio = 0.3;
    c.spider = {4, 1.5e-3, 20 * kDegree_rad};
    return c;
}

SpiderSpikes spikes_of(const Bench& bench) {
    const CameraModel& c = bench.camera;
    return {c.spider, spider_pupil(c), bench.grid, electrons_per_s_per_radiance(c, bench.grid)};
}

TEST(Spider, VanesTakeTheirAreaFromTheAperture) {
    CameraModel c = spider_camera();
    const double with = aperture_area_m2(c);
    c.spider.vanes = 0;
    const double d = 0.5 / 8;
    EXPECT_NEAR(aperture_area_m2(c) - with, 4 * 1.5e-3 * 0.5 * d * 0.7, 1e-12);
}

// A point's light is all there, spikes and all: what leaves the frame apart.
TEST(Spider, EnergyIsKept) {
    const CameraModel c = spider_camera();
    Bench bench(c, {16, 1, 1});
    const PointSource p = point_at(128.3, 127.8, 1e-6);
    const double all = static_cast<double>(electrons_per_s_per_irradiance(c, bench.grid)[0]) * 1e-6;
    const double kept = sum(bench.expose({.exposure_s = 1}, {&p, 1})) / all;
    const double share = spikes_of(bench).share();
    // Beyond 128 px along it: the integral of sinc^2 is about 1 / (pi^2 u0 X), u0 = w / (lambda f).
    const double u0 = 1.5e-3 / (0.55e-6 * 0.5) * 5.5e-6;
    EXPECT_NEAR(kept, 1 - share / (kPi * kPi * u0 * 135), 0.002);
    EXPECT_GT(share, 0.04);
}

// A slit's Fraunhofer pattern: along the spike sinc^2(w x / (lambda f)).
TEST(Spider, SpikesStandAcrossTheVanesAsTheirSlitsDo) {
    const CameraModel c = spider_camera();
    Bench bench(c, {16, 1, 1});
    const PointSource p = point_at(128.5, 128.5, 2e-6);
    const ElectronImage& e = bench.expose({.exposure_s = 1}, {&p, 1});
    const double all = static_cast<double>(electrons_per_s_per_irradiance(c, bench.grid)[0]) * 2e-6;
    const SpiderSpikes spikes = spikes_of(bench);
    for (const double r : {50.0, 70.0, 90.0}) {
        // Across a spike at 110 degrees, its light within 6 px, per px of its length.
        const double psi = (20 + 90) * kDegree_rad;
        double line = 0;
        int columns = 0;
        for (int y = 0; y < 256; ++y)
            for (int x = 0; x < 256; ++x) {
                const double dx = x - 128.0, dy = y - 128.0;
                const double along = dx * std::cos(psi) + dy * std::sin(psi),
                             across = dy * std::cos(psi) - dx * std::sin(psi);
                if (std::abs(along - r) < 6 && std::abs(across) < 6) line += at(e, x, y), ++columns;
            }
        double expected = 0;
        constexpr int kSteps = 4000;
        for (int i = 0; i < kSteps; ++i) {
            const double x = r - 6 + 12.0 * (i + 0.5) / kSteps;
            // The mean over the bin's wavelengths.
            for (int k = 0; k < 50; ++k) {
                const double u0 = 1.5e-3 / ((0.5 + 0.1 * (k + 0.5) / 50) * 1e-6 * 0.5) * 5.5e-6;
                expected += u0 * std::pow(std::sin(kPi * u0 * x) / (kPi * u0 * x), 2) * 12.0 / kSteps / 50;
            }
        }
        // Two of the four vanes make this line.
        EXPECT_NEAR(line / (all * spikes.share() * 0.5 * expected), 1, 0.06) << r;
        EXPECT_GT(columns, 100);
    }
    // Between the spikes there is none.
    EXPECT_LT(at(e, 128 + 60, 128 + 60),
              0.01 * at(e, 128 + static_cast<int>(85 * std::cos(110 * kDegree_rad)),
                        128 + static_cast<int>(85 * std::sin(110 * kDegree_rad))));
}

// An extended picture gets them by MTF_sys: its even parts keep their light, and contrast falls at once.
TEST(Spider, TheTransferFunctionHasThem) {
    const CameraModel c = spider_camera();
    CameraModel bare = c;
    bare.spider = {};
    const Bench with(c), without(bare);
    const double share = spikes_of(with).share();
    EXPECT_NEAR(with.chain.mtf(0, 0), 1, 2e-6);  // sums of floats
    // Far beyond w / (lambda f) in every direction nothing of the spikes is left.
    EXPECT_NEAR(with.chain.mtf(0.2, 0.25) / without.chain.mtf(0.2, 0.25), 1 - share, 1e-6);
    // Along a vane (20 degrees) its transfer function is still high where across it is gone.
    const SpiderSpikes spikes = spikes_of(with);
    const double f = 0.05, a = 20 * kDegree_rad;
    EXPECT_GT(spikes.transfer(f * std::cos(a), f * std::sin(a)), 0.3);
    EXPECT_LT(spikes.transfer(f * std::cos(a + kPi / 4), f * std::sin(a + kPi / 4)), 0.01);
}

TEST(Spider, RefusesWhatCannotBe) {
    CameraModel c = spider_camera();
    c.spider.width_m = 0;
    EXPECT_THROW(validate(c), InputError);
    c.spider.width_m = 0.02;
    EXPECT_THROW(validate(c), InputError);
    c.spider.width_m = 1e-3;
    EXPECT_NO_THROW(validate(c));
}

}  // namespace
}  // namespace hilcam
