#include "emulator/zoo/pan_change.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sensor/camera_model.h"

namespace hilcam {
namespace {

constexpr int kPanSide = 16;

ElectronImage pan_even(double charge_e) {
    ElectronImage image(kPanSide, kPanSide);
    for (float& e : image.all()) e = static_cast<float>(charge_e);
    return image;
}
// Every other column more, the others less.
ElectronImage striped(double charge_e, double by_e) {
    ElectronImage image = pan_even(charge_e);
    for (int y = 0; y < kPanSide; ++y)
        for (int x = 0; x < kPanSide; ++x)
            image.row(y)[static_cast<std::size_t>(x)] += static_cast<float>(x % 2 == 0 ? by_e : -by_e);
    return image;
}

class Pan : public testing::Test {
  protected:
    Pan() {
        camera_.read_noise_e = 10, camera_.gain_dn_e = 1;
        camera_.has_gain_dn_e = true;
        surface_.width = surface_.height = kPanSide;
        surface_.smooth.assign(kPanSide * kPanSide, 0), surface_.near_object.assign(kPanSide * kPanSide, 1);
    }
    PanChange change(const ElectronImage& still, const ElectronImage& moved, const ElectronImage& known,
                     double error_e) const {
        const SensorNoise noise(camera_, 0);
        return pan_change({still, moved}, {pan_even(1000), pan_even(0), pan_even(0)},
                          {known, pan_even(error_e)}, surface_, noise);
    }
    double sigma_e() const { return SensorNoise(camera_, 0).sigma_e(1000, 0); }
    CameraModel camera_;
    SurfacePixels surface_;
};

// What is off by a pattern that stays does not change; nor does what changes as the truth does.
TEST_F(Pan, WhatChangesAsTheReferenceDoesIsNoExcess) {
    EXPECT_EQ(change(striped(1000, 300), striped(1000, 300), pan_even(0), 0).excess_rms(), 0);
    const PanChange same = change(pan_even(1000), striped(1000, 50), striped(0, 50), 0);
    EXPECT_NEAR(same.excess_rms(), 0, 1e-9);
    EXPECT_NEAR(same.reference_rms(), 50 / sigma_e(), 1e-6);
    EXPECT_EQ(same.lit_px, static_cast<std::size_t>(kPanSide) * kPanSide);
}

TEST_F(Pan, TheRestIsInTheSensorsNoise) {
    EXPECT_NEAR(change(pan_even(1000), striped(1000, 80), striped(0, 50), 0).excess_rms(), 30 / sigma_e(),
                1e-6);
    EXPECT_NEAR(change(striped(1000, 30), pan_even(1000), striped(0, 50), 0).excess_rms(), 80 / sigma_e(),
                1e-6);
}

// Own error comes off in quadrature: 5^2 - 3^2 = 4^2; more of it than there is to explain leaves nothing.
TEST_F(Pan, TheReferencesOwnErrorComesOff) {
    EXPECT_NEAR(change(pan_even(1000), striped(1000, 50), pan_even(0), 30).excess_rms(), 40 / sigma_e(),
                1e-6);
    EXPECT_EQ(change(pan_even(1000), striped(1000, 20), pan_even(0), 30).excess_rms(), 0);
}

TEST_F(Pan, SumsOfTwoPicturesAreAsOfOne) {
    PanChange both = change(pan_even(1000), striped(1000, 30), pan_even(0), 0);
    both += change(pan_even(1000), striped(1000, 40), pan_even(0), 0);
    EXPECT_NEAR(both.excess_rms(), std::sqrt((900 + 1600) / 2.0) / sigma_e(), 1e-6);
}

TEST_F(Pan, OnlyWhatIsNearAnObjectCounts) {
    surface_.near_object.assign(kPanSide * kPanSide, 0);
    surface_.near_object[7] = 1;
    const PanChange one = change(pan_even(1000), striped(1000, 30), pan_even(0), 0);
    EXPECT_EQ(one.lit_px, 1u);
    EXPECT_NEAR(one.excess_rms(), 30 / sigma_e(), 1e-6);
}

}  // namespace
}  // namespace hilcam
