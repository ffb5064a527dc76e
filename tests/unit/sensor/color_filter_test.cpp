#include <gtest/gtest.h>

#include "sensor/focal_plane.h"
#include "tests/support/cameras.h"

namespace hilcam {
namespace {

TEST(ColorFilters, EveryPixelHasItsOwnFiltersElectrons) {
    CameraModel c = gaussian_camera(0.4);
    c.color_filter = {
        "RG GB", {{"R", Curve::constant(0.8)}, {"G", Curve::constant(0.5)}, {"B", Curve::constant(0.2)}}};
    c.window_px = {1, 0, 32, 32};
    Bench bench(c);
    bench.fill(10);
    const ElectronImage& e = bench.expose({.exposure_s = 1});
    CameraModel open = c;
    open.color_filter = {};
    const double all = 10 * per_radiance(open, bench.grid);
    // The window begins one column to the right: GR BG.
    EXPECT_NEAR(at(e, 10, 10) / all, 0.5, 1e-4);
    EXPECT_NEAR(at(e, 11, 10) / all, 0.8, 1e-4);
    EXPECT_NEAR(at(e, 10, 11) / all, 0.2, 1e-4);
    EXPECT_NEAR(at(e, 11, 11) / all, 0.5, 1e-4);
}

TEST(ColorFilters, CrosstalkMixesNeighbouringColours) {
    CameraModel c = gaussian_camera(0.4);
    c.color_filter = {
        "RG GB", {{"R", Curve::constant(0.8)}, {"G", Curve::constant(0.5)}, {"B", Curve::constant(0.2)}}};
    c.crosstalk_fraction = 0.02;
    Bench bench(c);
    bench.fill(10);
    const ElectronImage& e = bench.expose({.exposure_s = 1});
    CameraModel open = c;
    open.color_filter = {};
    const double all = 10 * per_radiance(open, bench.grid);
    EXPECT_NEAR(at(e, 10, 10) / all, 0.92 * 0.8 + 0.08 * 0.5, 1e-4);
    EXPECT_NEAR(at(e, 11, 10) / all, 0.92 * 0.5 + 0.04 * 0.8 + 0.04 * 0.2, 1e-4);
}

}  // namespace
}  // namespace hilcam
