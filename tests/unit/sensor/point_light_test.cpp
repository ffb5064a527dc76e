// Many points at once: drawn by all threads in bands of rows, they give what each gives by itself.

#include "sensor/point_light.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "tests/support/cameras.h"

namespace hilcam {
namespace {

// All over the picture and beside it, from a tenth of an electron to ten thousands: images of all sizes.
std::vector<PointSource> random_points(int count, double per_irradiance) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-10, 74), decades(-1, 4.5);
    std::vector<PointSource> points;
    for (int i = 0; i < count; ++i)
        points.push_back(
            point_at(place(random), place(random), std::pow(10.0, decades(random)) / per_irradiance));
    return points;
}

double electrons_per_irradiance(const CameraModel& camera) {
    return static_cast<double>(electrons_per_s_per_irradiance(camera, SpectralGrid({0.5, 0.6}))[0]);
}

// Each drawn into a picture of its own; the pictures summed in the points' order.
std::vector<float> one_by_one(Bench& bench, const Exposure& exposure, std::span<const PointSource> points) {
    std::vector<float> sum(64 * 64);
    for (const PointSource& point : points) {
        const std::span<const float> alone = bench.expose(exposure, {&point, 1}).all();
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += alone[i];
    }
    return sum;
}

// tolerance: of the brightest pixel; 0: bit by bit. What a point adds to a pixel in several parts is summed
// in another order when it is by itself: of some thousand parts each rounds the sum by 6e-8 at most, up or
// down.
void expect_the_same(Bench& bench, const Exposure& exposure, std::span<const PointSource> points,
                     float tolerance = 1e-5f) {
    const std::vector<float> expected = one_by_one(bench, exposure, points);
    const float most = *std::max_element(expected.begin(), expected.end());
    ASSERT_GT(most, 0);
    const auto together = [&] {
        const std::span<const float> all = bench.expose(exposure, points).all();
        return std::vector<float>(all.begin(), all.end());
    };
    const std::vector<float> all = together();
    for (std::size_t i = 0; i < all.size(); ++i) ASSERT_NEAR(all[i], expected[i], tolerance * most) << i;
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(together(), all);
}

TEST(PointLight, ManyPointsAreTheSumOfThePointsInTheirOrder) {
    Bench bench(camera_64());
    expect_the_same(bench, {.exposure_s = 1}, random_points(500, electrons_per_irradiance(bench.camera)), 0);
}

TEST(PointLight, SoAreTrailsOfATurningCamera) {
    Bench bench(camera_64());
    // Up to 30 px about the boresight, and along the rows.
    const Exposure exposure{.exposure_s = 1, .camera_rate_rad_s = {0.001, 0, 0.5}};
    expect_the_same(bench, exposure, random_points(300, electrons_per_irradiance(bench.camera)));
}

// A hundred and sixty-nine spots a point: more than are drawn at once, and the last of a batch is in the
// midst of a point.
TEST(PointLight, SoArePointsThatJitter) {
    CameraModel camera = camera_64();
    camera.jitter.psd_arcsec2_hz = {{1, 10}, {1000, 10}};
    Bench bench(camera);
    expect_the_same(bench, {.exposure_s = 1}, random_points(100, electrons_per_irradiance(camera)));
}

TEST(PointLight, SoAreThoseUnderAMosaicWithCrosstalk) {
    CameraModel camera = camera_64();
    camera.color_filter.pattern = "RG GB";
    camera.color_filter.filters = {
        {"R", Curve::constant(0.5)}, {"G", Curve::constant(0.7)}, {"B", Curve::constant(0.9)}};
    camera.crosstalk_fraction = 0.02;
    Bench bench(camera);
    expect_the_same(bench, {.exposure_s = 1}, random_points(200, electrons_per_irradiance(camera)));
}

// Three ways to sum an image, by its light: their middles differ by one factor, of what lies outside. Faint
// points are interpolated by lines, which may be off by 0.005 e-.
TEST(PointLight, ImagesOfAllSizesHaveOneShape) {
    Bench bench(camera_64());
    const double per_irradiance = electrons_per_irradiance(bench.camera);
    for (const double y : {32.0, 32.21, 32.5, 32.97})
        for (const double x : {31.06, 31.5, 31.75}) {
            const auto middle = [&](double electrons) {
                const PointSource point = point_at(x, y, electrons / per_irradiance);
                const ElectronImage& image = bench.expose({.exposure_s = 1}, {&point, 1});
                std::vector<double> out;
                for (int j = -3; j <= 3; ++j)
                    for (int i = -3; i <= 3; ++i) out.push_back(at(image, 31 + i, 32 + j) / electrons);
                return out;
            };
            const std::vector<double> bright = middle(1e5);
            for (const double electrons : {0.1, 1.0, 10.0}) {
                const std::vector<double> faint = middle(electrons);
                const double factor = std::accumulate(faint.begin(), faint.end(), 0.0) /
                                      std::accumulate(bright.begin(), bright.end(), 0.0);
                EXPECT_NEAR(factor, 1, 0.1);
                for (std::size_t i = 0; i < faint.size(); ++i)
                    EXPECT_NEAR(faint[i], factor * bright[i], std::min(0.01, 0.005 / electrons))
                        << x << ' ' << y << ' ' << i << ' ' << electrons;
            }
        }
}

}  // namespace
}  // namespace hilcam
