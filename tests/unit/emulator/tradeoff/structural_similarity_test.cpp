#include "emulator/tradeoff/structural_similarity.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hilcam {
namespace {

constexpr double kRange_e = 10000, kC1 = 1e-4 * kRange_e * kRange_e, kC2 = 9e-4 * kRange_e * kRange_e;

// mean + contrast on one half of a chessboard's fields, mean - contrast on the other. Under the window, cut
// off at 5 px, the sign averages to some 1e-4 along each axis: 1e-8 of the contrast for both.
ElectronImage chessboard(double mean_e, double contrast_e) {
    ElectronImage image(40, 30);
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x)
            image.row(y)[static_cast<std::size_t>(x)] =
                static_cast<float>(mean_e + ((x + y) % 2 ? contrast_e : -contrast_e));
    return image;
}

double luminance(double a, double b) { return (2 * a * b + kC1) / (a * a + b * b + kC1); }

TEST(StructuralSimilarity, EqualPicturesHaveOne) {
    const ElectronImage image = chessboard(3000, 700);
    EXPECT_NEAR(*structural_similarity(image, image, kRange_e), 1, 1e-9);
}

TEST(StructuralSimilarity, OfAConstantShiftIsTheLuminanceTerm) {
    EXPECT_NEAR(*structural_similarity(chessboard(3000, 0), chessboard(4200, 0), kRange_e),
                luminance(3000, 4200), 1e-6);
    EXPECT_NEAR(*structural_similarity(chessboard(3000, 700), chessboard(4200, 700), kRange_e),
                luminance(3000, 4200), 1e-6);
}

TEST(StructuralSimilarity, OfInvertedContrastIsNegative) {
    // The same means; covariance minus the variance.
    const double variance = 700 * 700;
    EXPECT_NEAR(*structural_similarity(chessboard(3000, 700), chessboard(3000, -700), kRange_e),
                (-2 * variance + kC2) / (2 * variance + kC2), 1e-6);
}

TEST(StructuralSimilarity, NeedsAPictureOfTheWindowsSize) {
    EXPECT_TRUE(structural_similarity(ElectronImage(11, 11), ElectronImage(11, 11), kRange_e));
    EXPECT_FALSE(structural_similarity(ElectronImage(10, 11), ElectronImage(10, 11), kRange_e));
}

}  // namespace
}  // namespace hilcam
