// An edge whose MTF is a formula comes back to 0.003.

#include "sensor/measure/slanted_edge.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"
#include "sensor/mtf.h"
#include "sensor/noise.h"

namespace hilcam {
namespace {

constexpr double kDark = 200, kBright = 800;

struct EdgeShape {
    int width = 96, height = 200;
    double tilt_rad = 5 * kDegree_rad;  // of the edge from the columns
    bool horizontal = false;            // the picture turned over its diagonal
    double gaussian_px = 0;             // standard deviation of a Gaussian blur
    double offset_px = 0.3;             // of the edge from the middle
    double noise = 0;
    int filter_period = 1;  // only every n-th column and row counts
};

struct Picture {
    std::vector<double> value;
    std::vector<std::uint8_t> use;
    EdgePicture view;
};

// The mean of a blurred step over square pixels. A Gaussian blurred step is erf; its mean over a slanted
// pixel is taken over 64 x 64 places, which is good to 1e-5.
Picture draw(const EdgeShape& s) {
    const int width = s.horizontal ? s.height : s.width, height = s.horizontal ? s.width : s.height;
    Picture out;
    const double c = std::cos(s.tilt_rad), n = std::sin(s.tilt_rad);
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
            const int x = s.horizontal ? row : column, y = s.horizontal ? column : row;
            double sum = 0;
            constexpr int kParts = 64;
            const double middle =
                (x + 0.5 - 0.5 * s.width - s.offset_px) * c - (y + 0.5 - 0.5 * s.height) * n;
            if (std::abs(middle) > 1.5 + 6 * s.gaussian_px) {
                sum = middle > 0 ? 1 : 0;
            } else {
                for (int j = 0; j < kParts; ++j)
                    for (int i = 0; i < kParts; ++i) {
                        const double d =
                            middle + ((i + 0.5) / kParts - 0.5) * c - ((j + 0.5) / kParts - 0.5) * n;
                        sum += s.gaussian_px > 0 ? 0.5 * std::erfc(-d / s.gaussian_px / std::sqrt(2.0))
                                                 : (d > 0 ? 1 : 0);
                    }
                sum /= kParts * kParts;
            }
            const auto pixel = static_cast<std::uint32_t>(row * width + column);
            const double deviate = static_cast<double>(
                normal_quantile(uniform01(random_words({7, 1}, RandomPurpose::kSensorNoise, pixel)[0])));
            out.value.push_back(kDark + (kBright - kDark) * sum + s.noise * deviate);
            out.use.push_back(row % s.filter_period == 0 && column % s.filter_period == 0);
        }
    out.view = {width, height, out.value, out.use, s.noise};
    return out;
}

// Along the edge's normal: the pixel's square, seen aslant, and the blur.
double expected(const EdgeShape& s, double f) {
    const double gauss = std::exp(-2 * std::pow(kPi * s.gaussian_px * f, 2));
    return std::abs(sinc(f * std::cos(s.tilt_rad)) * sinc(f * std::sin(s.tilt_rad))) * gauss;
}

void expect_known_mtf(const EdgeShape& shape) {
    const Picture picture = draw(shape);
    const EdgeMtf mtf = slanted_edge_mtf(picture.view, {});
    ASSERT_EQ(mtf.frequency_cy_px.size(), 65u);
    EXPECT_DOUBLE_EQ(mtf.frequency_cy_px.back(), 1);
    for (std::size_t i = 0; i < mtf.mtf.size(); ++i)
        EXPECT_NEAR(mtf.mtf[i], expected(shape, mtf.frequency_cy_px[i]), 0.003)
            << mtf.frequency_cy_px[i] << " cycles/px, tilt " << shape.tilt_rad / kDegree_rad << ", blur "
            << shape.gaussian_px << (shape.horizontal ? ", horizontal" : "");
}

TEST(SlantedEdge, FindsTheMtfOfASquarePixelAndOfABlurredOne) {
    for (const bool horizontal : {false, true})
        for (const double blur_px : {0.0, 0.4, 1.0})
            for (const double tilt_deg : {-7.0, 5.0}) {
                EdgeShape shape;
                shape.horizontal = horizontal;
                shape.gaussian_px = blur_px;
                shape.tilt_rad = tilt_deg * kDegree_rad;
                expect_known_mtf(shape);
            }
}

TEST(SlantedEdge, OneColourOfAFilterPatternIsEnough) {
    EdgeShape shape;
    shape.filter_period = 2;
    shape.height = 256;
    shape.gaussian_px = 0.4;
    expect_known_mtf(shape);
}

TEST(SlantedEdge, TellsADifferentBlur) {
    EdgeShape shape;
    shape.gaussian_px = 0.40;
    const EdgeMtf mtf = slanted_edge_mtf(draw(shape).view, {});
    shape.gaussian_px = 0.42;
    EXPECT_GT(std::abs(mtf.mtf[32] - expected(shape, 0.5)), 0.006);
}

TEST(SlantedEdge, GivesTheDirectionOfTheNormal) {
    EdgeShape shape;
    EXPECT_NEAR(slanted_edge_mtf(draw(shape).view, {}).normal_rad, -5 * kDegree_rad, 1e-3);
    shape.horizontal = true;
    EXPECT_NEAR(slanted_edge_mtf(draw(shape).view, {}).normal_rad, 95 * kDegree_rad, 1e-3);
}

// A step of large surfaces that is greater than what is seen at the edge: light that is spread wide.
TEST(SlantedEdge, AKnownStepCountsWhatIsSpreadWide) {
    const EdgeShape shape;
    SlantedEdgeOptions options;
    options.step = (kBright - kDark) / 0.9;
    const EdgeMtf mtf = slanted_edge_mtf(draw(shape).view, options);
    EXPECT_NEAR(mtf.mtf[32], 0.9 * expected(shape, 0.5), 0.003);
}

TEST(SlantedEdge, ItsUncertaintyIsThatOfTheNoise) {
    // Noise of 5 % of the step: errors in units of their uncertainty have a root mean square of one. The
    // transform has about 50 independent values up to 1 cycle/px, so it is known to 10 %; three of that.
    EdgeShape shape;
    shape.noise = 0.05 * (kBright - kDark);
    shape.gaussian_px = 0.4;
    const EdgeMtf mtf = slanted_edge_mtf(draw(shape).view, {.step = kBright - kDark});
    double sum = 0;
    int count = 0;
    for (std::size_t i = 4; i < 48; ++i, ++count)
        sum += std::pow((mtf.mtf[i] - expected(shape, mtf.frequency_cy_px[i])) / mtf.uncertainty[i], 2);
    EXPECT_GT(std::sqrt(sum / count), 0.7);
    EXPECT_LT(std::sqrt(sum / count), 1.3);
}

TEST(SlantedEdge, RefusesPicturesWithoutAnEdgeItCanUse) {
    EdgeShape straight;
    straight.tilt_rad = 0;
    straight.offset_px = 0;
    EXPECT_THROW(slanted_edge_mtf(draw(straight).view, {}), InputError);
    EdgeShape small;
    small.height = 10;
    EXPECT_THROW(slanted_edge_mtf(draw(small).view, {}), InputError);
}

}  // namespace
}  // namespace hilcam
