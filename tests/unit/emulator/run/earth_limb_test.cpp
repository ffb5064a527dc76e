// The limb of the Earth from a low orbit: sixteen rays a pixel where its ground and its clouds end, one elsewhere.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "emulator/run/still_camera.h"
#include "emulator/scenario/app_config.h"

namespace hilcam {
namespace {

// Returns the mean charges of a strip about the limb of earth_day [e-].
std::vector<float> strip(std::vector<std::string> quality) {
    quality.insert(quality.end(),
                   {"camera.width_px=256", "camera.height_px=64", "camera.principal_point_px=[512, 16]"});
    const ScenarioConfig scenario =
        load_scenario(HILCAM_SOURCE_DIR "/configs/scenarios/earth_day.yaml", quality);
    StillCamera camera(scenario);
    camera.render({1, 1});
    const ElectronImage& electrons = camera.expose();
    return {electrons.all().begin(), electrons.all().end()};
}

// In the noise of inspector_1k (13 e-, full well 13500 e-) when the brightest hundredth has half of its full well, against a
// picture of four times as many pixels each way with four rays in each. Without the rims it is 0.39.
TEST(EarthLimb, IsAsGoodAsTheMeanOfManyRays) {
    const std::vector<float> seen = strip({}),
                             mean = strip({"quality.visibility=rays", "quality.samples_per_axis=2",
                                           "quality.oversampling=4"});
    std::vector<float> bright = mean;
    std::nth_element(bright.begin(), bright.begin() + static_cast<std::ptrdiff_t>(bright.size() * 99 / 100),
                     bright.end());
    const double scale = 6750 / static_cast<double>(bright[bright.size() * 99 / 100]);
    double squares = 0;
    for (std::size_t i = 0; i < mean.size(); ++i) {
        const double e = scale * static_cast<double>(mean[i]), off = scale * static_cast<double>(seen[i]) - e;
        squares += off * off / (e + 169);
    }
    const double rms = std::sqrt(squares / static_cast<double>(mean.size()));
    std::cout << "rms " << rms << " of the noise\n";
    EXPECT_LT(rms, 0.33);
}

}  // namespace
}  // namespace hilcam
