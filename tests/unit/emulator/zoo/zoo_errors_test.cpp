#include "emulator/zoo/zoo_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sensor/camera_model.h"

namespace hilcam {
namespace {

constexpr int kErrorsSide = 20;

ElectronImage even_view(double charge_e) {
    ElectronImage image(kErrorsSide, kErrorsSide);
    for (float& e : image.all()) e = static_cast<float>(charge_e);
    return image;
}

class ZooErrors : public testing::Test {
  protected:
    ZooErrors() {
        camera_.read_noise_e = 10, camera_.gain_dn_e = 1;
        camera_.has_gain_dn_e = true;
        surface_.width = surface_.height = kErrorsSide;
        surface_.smooth.assign(kErrorsSide * kErrorsSide, 1),
            surface_.near_object.assign(kErrorsSide * kErrorsSide, 1);
        reference_.mean = even_view(1000), reference_.dark = even_view(0), reference_.error = even_view(0);
        reference_.change = even_view(0), reference_.change_error = even_view(0);
    }
    ZooFigures figures(const ElectronImage& picture) {
        return zoo_errors({picture, picture}, reference_, surface_, SensorNoise(camera_, 0), pixels_);
    }
    double sigma_e(double charge_e) const { return SensorNoise(camera_, 0).sigma_e(charge_e, 0); }

    CameraModel camera_;
    SurfacePixels surface_;
    ZooReference reference_;
    ZooPixels pixels_;
};

// 5 sigma are there, of which 3 are the reference's own: 4 are the picture's.
TEST_F(ZooErrors, TheReferencesOwnErrorComesOffInQuadrature) {
    reference_.error = even_view(3 * sigma_e(1000));
    const ZooFigures found = figures(even_view(1000 + 5 * sigma_e(1000)));
    EXPECT_NEAR(found.error.rms, 5, 1e-5);
    EXPECT_NEAR(found.error.p99, 5, 1e-5);
    EXPECT_NEAR(found.reference.rms, 3, 1e-5);
    EXPECT_NEAR(found.error_rms, 4, 1e-5);
    EXPECT_EQ(pixels_.errors.size(), static_cast<std::size_t>(kErrorsSide) * kErrorsSide);
}

TEST_F(ZooErrors, PixelsOfSeveralViewsAreAsOfOne) {
    figures(even_view(1000 + 1 * sigma_e(1000)));
    figures(even_view(1000 - 7 * sigma_e(1000)));
    ZooFigures both;
    set_errors(pixels_, both);
    EXPECT_EQ(both.error.lit_px, 2u * kErrorsSide * kErrorsSide);
    EXPECT_NEAR(both.error_rms, 5, 1e-5);  // of 1 and 49 the mean is 25
    EXPECT_NEAR(both.error.p99, 7, 1e-5);
}

TEST_F(ZooErrors, FarFromObjectsNoErrorCounts) {
    surface_.near_object.assign(kErrorsSide * kErrorsSide, 0);
    const ZooFigures found = figures(even_view(2000));
    EXPECT_EQ(found.error.lit_px, 0u);
    EXPECT_EQ(found.pan.lit_px, 0u);
}

TEST_F(ZooErrors, LightsOfOnePictureAloneAreFalseOrLost) {
    reference_.mean = even_view(10);
    ElectronImage picture = even_view(10);
    picture.data()[30] = 500, picture.data()[60] = 5000;            // false
    reference_.mean.data()[200] = 3000;                             // lost
    reference_.mean.data()[250] = 3000, picture.data()[250] = 800;  // dimmed, not lost
    const ZooFigures found = figures(picture);
    EXPECT_EQ(found.false_lights, 2);
    EXPECT_EQ(found.lost_lights, 1);
}

// A pixel that the reference itself does not know is nobody's fault: 1000 e- are within five times 300.
TEST_F(ZooErrors, WhereTheReferenceIsUncertainALightIsNotFalse) {
    reference_.mean = even_view(10);
    ElectronImage picture = even_view(10);
    picture.data()[4 * kErrorsSide + 4] = 1000;
    EXPECT_EQ(figures(picture).false_lights, 1);
    reference_.error.data()[4 * kErrorsSide + 5] =
        900;  // beside it: a third of it is the root of nine pixels' mean square
    EXPECT_EQ(figures(picture).false_lights, 0);
}

}  // namespace
}  // namespace hilcam
