#include "emulator/clone/image_lag.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

// Eight bright frames of 1000, `partly` lit ones of 400, and dark ones with 2 % left, halved from frame to
// frame.
std::vector<double> lag_frames(std::size_t darks, std::size_t partly = 0, double lag = 0.02) {
    std::vector<double> out(8, 1000.0);
    out.insert(out.end(), partly, 400.0);
    for (std::size_t k = 0; k < darks; ++k)
        out.push_back(1000 * lag * std::pow(0.5, static_cast<double>(k)) + (k % 2 ? 0.1 : -0.1));
    return out;
}

std::string lag_refusal(const std::vector<double>& means) {
    try {
        image_lag(means, "lag_2ms");
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(ImageLag, IsThePartThatIsLeft) {
    const ImageLag lag = image_lag(lag_frames(40), "lag");
    EXPECT_EQ(lag.passed_over, 0u);
    for (std::size_t k = 0; k < lag.left.size(); ++k)
        EXPECT_NEAR(lag.left[k].value, 0.02 * std::pow(0.5, static_cast<double>(k)),
                    3 * lag.left[k].uncertainty);
    EXPECT_NEAR(lag.left[0].uncertainty, 1e-4, 2e-5);
    EXPECT_EQ(image_lag(lag_frames(40, 1), "lag").passed_over, 1u);
    EXPECT_NEAR(image_lag(lag_frames(40, 1), "lag").left[0].value, 0.02, 1e-3);
}

TEST(ImageLag, SeveralDecaysAreMoreExact) {
    std::vector<double> twice = lag_frames(40), again = lag_frames(40);
    twice.insert(twice.end(), again.begin(), again.end());
    EXPECT_NEAR(image_lag(twice, "lag").left[0].uncertainty,
                image_lag(again, "lag").left[0].uncertainty / std::sqrt(2.0), 1e-9);
}

TEST(ImageLag, OtherFramesAreRefused) {
    EXPECT_THAT(lag_refusal({}), HasSubstr("lag_2ms: found no bright frame with 12 dark ones after it"));
    EXPECT_THAT(lag_refusal(lag_frames(11)), HasSubstr("found no bright frame"));
    EXPECT_THAT(lag_refusal(std::vector<double>(30, 5.0)), HasSubstr("found no bright frame"));
    EXPECT_THAT(lag_refusal(lag_frames(40, 3)), HasSubstr("found 3 frames between bright and dark"));
}

}  // namespace
}  // namespace hilcam
