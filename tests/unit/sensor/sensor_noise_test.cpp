#include "sensor/sensor_noise.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hilcam {
namespace {

TEST(SensorNoise, IsTheRootOfTheSumOfShotReadQuantisationAndFixedVariances) {
    CameraModel c;
    c.read_noise_e = 3, c.reset_noise_e = 4;  // 25 e-^2
    c.gain_dn_e = 0.5;                        // 1 / (12 0.25) = 1/3
    c.has_gain_dn_e = true;
    c.dsnu_e = 2, c.fixed_pattern.row_e = 1, c.fixed_pattern.column_e = 2;  // 4 + 1 + 4
    c.fixed_pattern.dark_current_fraction = 0.1;                            // of 100 e-: 100
    c.prnu_fraction = 0.006, c.fixed_pattern.column_gain_fraction = 0.008;  // 0.01 of 10,000 e-: 10,000
    EXPECT_NEAR(SensorNoise(c, 0).sigma_e(10100, 100), std::sqrt(10100 + 25 + 1.0 / 3 + 9 + 100 + 10000),
                1e-9);
    EXPECT_NEAR(SensorNoise(c, 0).sigma_e(0, 0), std::sqrt(25 + 1.0 / 3 + 9), 1e-12);
    // 20 dB are ten times the gain, so a hundredth of the quantisation.
    EXPECT_NEAR(SensorNoise(c, 20).sigma_e(0, 0), std::sqrt(25 + 1.0 / 300 + 9), 1e-12);
}

}  // namespace
}  // namespace hilcam
