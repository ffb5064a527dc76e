// An edge whose MTF is a formula comes back from each piece, within the stated uncertainty.

#include "emulator/clone/edge_pieces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"
#include "sensor/mtf.h"
#include "sensor/noise.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

constexpr double kBright = 1000, kDark = 100;

struct EdgeShape {
    double tilt_deg = 5;
    bool horizontal = false;
    double blur_px = 0.5;  // standard deviation of a Gaussian
    double noise = 5;
    double bend_px = 0;  // of the edge's middle against its ends
    std::uint32_t seed = 1;
};

struct Picture {
    int width = 160, height = 240;
    std::vector<double> value;
    std::vector<std::uint8_t> use;
    EdgePicture view(double noise) const { return {width, height, value, use, noise}; }
};

// Blurred step over square pixels, as the mean of 16 x 16 places.
Picture draw(const EdgeShape& s) {
    Picture out;
    if (s.horizontal) std::swap(out.width, out.height);
    const double c = std::cos(s.tilt_deg * kDegree_rad), n = std::sin(s.tilt_deg * kDegree_rad);
    constexpr int kParts = 16;
    for (int row = 0; row < out.height; ++row)
        for (int column = 0; column < out.width; ++column) {
            const double x = (s.horizontal ? row : column) + 0.5 - 80.3,
                         y = (s.horizontal ? column : row) + 0.5 - 120;
            const double bend = s.bend_px * (1 - square(y / 120));
            double sum = 0;
            for (int j = 0; j < kParts; ++j)
                for (int i = 0; i < kParts; ++i) {
                    const double px = x - bend + (i + 0.5) / kParts - 0.5, py = y + (j + 0.5) / kParts - 0.5;
                    sum += 0.5 * std::erfc((px * c - py * n) / s.blur_px / std::sqrt(2.0));
                }
            const auto pixel = static_cast<std::uint32_t>(row * out.width + column);
            const double deviate = static_cast<double>(
                normal_quantile(uniform01(random_words({s.seed, 1}, RandomPurpose::kSensorNoise, pixel)[0])));
            out.value.push_back(kDark + (kBright - kDark) * sum / (kParts * kParts) + s.noise * deviate);
            out.use.push_back(1);
        }
    return out;
}

double expected(const EdgeShape& s, double f) {
    const double tilt = s.tilt_deg * kDegree_rad;
    return std::abs(sinc(f * std::cos(tilt)) * sinc(f * std::sin(tilt))) *
           std::exp(-2 * square(kPi * s.blur_px * f));
}

std::vector<EdgePiece> measured(const EdgeShape& s) {
    return measure_edge_pieces(draw(s).view(s.noise), "edge");
}

std::string edge_refusal(const Picture& picture) {
    try {
        measure_edge_pieces(picture.view(5), "edge_2ms");
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(EdgePieces, ShowTheMtfAlongTheEdge) {
    for (const bool horizontal : {false, true}) {
        EdgeShape shape;
        shape.horizontal = horizontal;
        const std::vector<EdgePiece> pieces = measured(shape);
        // 240 rows are five pieces of 48.
        ASSERT_EQ(pieces.size(), 5u);
        for (const EdgePiece& piece : pieces) {
            EXPECT_NEAR(horizontal ? piece.place_px.y : piece.place_px.x, 80, 12);
            EXPECT_NEAR(std::abs(std::sin(piece.mtf.normal_rad)),
                        horizontal ? std::cos(5 * kDegree_rad) : std::sin(5 * kDegree_rad), 0.01);
            for (const std::size_t k : {8u, 16u, 24u, 32u})
                EXPECT_NEAR(piece.mtf.mtf[k], expected(shape, piece.mtf.frequency_cy_px[k]),
                            4 * piece.mtf.uncertainty[k] + 0.005);
        }
    }
}

// Errors over 25 seeds and five pieces each are as large as stated: their mean square is 1 within 35 %, four
// standard deviations of that of 125 errors whose own sigma has 15 degrees of freedom.
TEST(EdgePieces, UncertaintyIsThatOfTheErrors) {
    double sum = 0, count = 0;
    for (std::uint32_t seed = 1; seed <= 25; ++seed) {
        EdgeShape shape;
        shape.seed = seed, shape.noise = 20;
        for (const EdgePiece& piece : measured(shape)) {
            const double error = piece.mtf.mtf[16] - expected(shape, piece.mtf.frequency_cy_px[16]);
            sum += square(error / piece.mtf.uncertainty[16]), ++count;
        }
    }
    EXPECT_GT(sum / count, 0.65);
    EXPECT_LT(sum / count, 1.6);  // the mean square of Student's t of 15 degrees is 1.15
}

TEST(EdgePieces, ABentEdgeIsFollowed) {
    EdgeShape shape;
    shape.bend_px = 1.5;
    for (const EdgePiece& piece : measured(shape))
        EXPECT_NEAR(piece.mtf.mtf[16], expected(shape, 0.25), 4 * piece.mtf.uncertainty[16] + 0.02);
}

TEST(EdgePieces, OthersAreRefused) {
    EdgeShape upright, steep, blurred;
    upright.tilt_deg = 0, steep.tilt_deg = 45;
    EXPECT_THAT(edge_refusal(draw(upright)),
                HasSubstr("edge_2ms: found an edge at 0.0 degrees from the columns; "
                          "accepted: one straight edge"));
    EXPECT_THAT(edge_refusal(draw(steep)), HasSubstr("found an edge at 4"));
    Picture flat = draw({});
    for (double& value : flat.value) value = 500 + std::fmod(value, 5);
    EXPECT_THAT(edge_refusal(flat), HasSubstr("edge_2ms: found no edge in"));
    Picture small = draw({});
    small.height = 30;
    EXPECT_THAT(edge_refusal(small), HasSubstr("found a picture of 160 x 30"));
}

TEST(EdgePieces, AJackknifeOfAMeanIsItsStandardError) {
    // 1, 2, 3, 4 without each in turn; standard error of their mean: sqrt(5 / 3 / 4).
    EXPECT_NEAR(jackknife_uncertainty({3, 8.0 / 3, 7.0 / 3, 2}), std::sqrt(5.0 / 12), 1e-12);
}

}  // namespace
}  // namespace hilcam
