#include "sensor/convolution/moment_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "render/vocabulary/units.h"
#include "sensor/mtf.h"
#include "tests/support/statistics.h"
#include "tests/support/vector_widths.h"

namespace hilcam {
namespace {

constexpr double kKernelSigma_px = 0.6;
// A Gaussian over square pixels: at 1 cycle per pixel it is zero.
std::complex<double> transfer(double u, double v) {
    return sinc(u) * sinc(v) * gaussian_mtf(std::hypot(u, v), kKernelSigma_px);
}
// The share of a point's light that a pixel gets whose middle lies there from the point.
double share_at(double x, double y) {
    const auto along = [](double from) {
        return normal_cdf((from + 0.5) / kKernelSigma_px) - normal_cdf((from - 0.5) / kKernelSigma_px);
    };
    return along(x) * along(y);
}
// What a pixel gets of light in the next but so many as the picture as a whole is convolved.
double smooth_at(int x, int y) {
    constexpr int kSteps = 64;
    std::complex<double> sum = 0;
    for (int j = -kSteps / 2; j < kSteps / 2; ++j)
        for (int i = -kSteps / 2; i < kSteps / 2; ++i) {
            const double u = i / 1.0 / kSteps, v = j / 1.0 / kSteps;
            sum += smooth_transfer(transfer, u, v) *
                   std::polar(1.0 / (kSteps * kSteps), 2 * kPi * (u * x + v * y));
        }
    return sum.real();
}
// The smooth difference that light of 1 at 0 makes in the pixel at x.
double slope_at(int x) {
    const auto light = [&](int at) { return at == 0 ? 1.0f : 0.0f; };
    return static_cast<double>(smooth_difference(light(x - 2), light(x - 1), light(x + 1), light(x + 2)));
}

// Light in one quarter of a pixel, among nothing: the smooth differences of it and of its neighbours are taken away.
TEST(MomentKernels, PutLightWhereItComesFrom) {
    const MomentKernels kernels(transfer);
    for (const double right : {-1.0, 1.0})
        for (const double down : {-1.0, 1.0})
            for (int y = -3; y <= 3; ++y)
                for (int x = -3; x <= 3; ++x) {
                    double sum = smooth_at(x, y) + right * kernels.weight(0, x, y) +
                                 down * kernels.weight(1, x, y) + right * down * kernels.weight(2, x, y);
                    for (int j = -2; j <= 2; ++j)
                        for (int i = -2; i <= 2; ++i) {
                            const auto weight = [&](std::size_t part) {
                                return static_cast<double>(kernels.weight(part, x - i, y - j));
                            };
                            sum -= (j == 0 ? slope_at(i) * weight(0) : 0) +
                                   (i == 0 ? slope_at(j) * weight(1) : 0) +
                                   slope_at(i) * slope_at(j) * weight(2);
                        }
                    EXPECT_NEAR(sum, share_at(x - 0.25 * right, y - 0.25 * down), 5e-4)
                        << right << ' ' << down << ' ' << x << ' ' << y;
                }
}

// Slow changes are convolved as the transfer function says: a picture by halves is no softer.
TEST(MomentKernels, LeaveSmoothLightAsItIs) {
    // A whole pixel is a mean over its area, a half over half as much: between the two is what halves have less.
    const auto by_pixels = [](double u, double v) {
        return transfer(u, v) * (sinc(u / 2) * sinc(v / 2) / (sinc(u) * sinc(v)));
    };
    for (const double u : {0.0, 0.1, 0.2, 0.3})
        for (const double v : {0.0, 0.15, 0.3})
            EXPECT_NEAR(std::abs(smooth_transfer(transfer, u, v)) / std::abs(by_pixels(u, v)), 1, 0.06)
                << u << ' ' << v;
}

// The kernels move light within the picture: none is added or lost.
TEST(MomentKernels, SumToNothing) {
    MomentKernels kernels(transfer);
    for (const Vec2d smear_px : {Vec2d{0, 0}, Vec2d{1.3, 0.4}}) {
        ASSERT_TRUE(kernels.prepare({.smear_px = smear_px}));
        for (const std::size_t d : {0u, 1u, 2u}) {
            double sum = 0;
            for (int y = -kernels.reach_px(); y <= kernels.reach_px(); ++y)
                for (int x = -kernels.reach_px(); x <= kernels.reach_px(); ++x)
                    sum += static_cast<double>(kernels.weight(d, x, y));
            EXPECT_NEAR(sum, 0, 1e-6) << d;
        }
    }
}

// A smear is the mean of kernels along it, and a Gaussian that of kernels about; both against many of them.
TEST(MomentKernels, BlurAsTheirFrameDoes) {
    MomentKernels kernels(transfer);
    for (const double smear_px : {0.3, 1.0, 3.0}) {
        const FrameBlur blur{.smear_px = {0.8 * smear_px, 0.6 * smear_px}, .sigma_px = {0.3, 0.3}};
        ASSERT_TRUE(kernels.prepare(blur));
        for (int y = -3; y <= 3; ++y)
            for (int x = -3; x <= 3; ++x) {
                double mean = 0;
                constexpr int kSteps = 100;
                for (int i = 0; i < kSteps; ++i) {
                    const double t = (i + 0.5) / kSteps - 0.5;
                    const auto along = [&](double from, double edge) {
                        const double sigma = std::hypot(kKernelSigma_px, 0.3);
                        return normal_cdf((from + edge) / sigma);
                    };
                    const auto share = [&](double px, double py) {
                        return (along(px, 0.5) - along(px, -0.5)) * (along(py, 0.5) - along(py, -0.5));
                    };
                    const double px = x - t * blur.smear_px.x, py = y - t * blur.smear_px.y;
                    mean += (share(px - 0.25, py - 0.25) + share(px - 0.25, py + 0.25) -
                             share(px + 0.25, py - 0.25) - share(px + 0.25, py + 0.25)) /
                            4 / kSteps;
                }
                EXPECT_NEAR(kernels.weight(0, x, y), mean, 1.5e-3) << smear_px << ' ' << x << ' ' << y;
            }
    }
    EXPECT_FALSE(kernels.prepare({.smear_px = {20, 0}}));
    EXPECT_FALSE(kernels.prepare({.sigma_px = {2, 0}}));
}

// Differences here and there in a block and about it, rows without any among them.
float difference(int d, int x, int y) {
    return y % 9 > 2 && (x * 7 + y * 13 + d * 5) % 11 == 0 ? static_cast<float>((x + 2 * y) % 17 - 8) : 0.0f;
}
MomentKernels::Parts differences() {
    MomentKernels::Parts parts{};
    constexpr int kSide = MomentKernels::kSide_px;
    for (int d = 0; d < 3; ++d)
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x)
                parts[static_cast<std::size_t>(d)][static_cast<std::size_t>(y * kSide + x)] =
                    difference(d, x, y);
    return parts;
}

// Blocks are convolved as their definition says, whatever lies about them.
TEST(MomentKernels, ConvolveABlock) {
    const MomentKernels kernels(transfer);
    constexpr int kReach = MomentKernels::kMaxReach_px, kColumns = 29, kRows = 31;
    std::vector<float> out(40 * (kRows + 1), 1.0f);
    kernels.add(differences(), kColumns, kRows, out.data(), 40);
    for (int y = 0; y <= kRows; ++y)
        for (int x = 0; x < 40; ++x) {
            double expected = 1;
            for (int d = 0; d < 3 && x < kColumns && y < kRows; ++d)
                for (int j = -kernels.reach_px(); j <= kernels.reach_px(); ++j)
                    for (int i = -kernels.reach_px(); i <= kernels.reach_px(); ++i)
                        expected += static_cast<double>(kernels.weight(static_cast<std::size_t>(d), i, j)) *
                                    static_cast<double>(difference(d, x + kReach - i, y + kReach - j));
            EXPECT_NEAR(out[static_cast<std::size_t>(40 * y + x)], expected, 1e-4) << x << ' ' << y;
        }
}

TEST(MomentKernels, ConvolveAlikeByAnyWidth) {
    const MomentKernels kernels(transfer);
    expect_same_by_any_width([&] {
        std::vector<float> out(40 * 32, 0.25f);
        kernels.add(differences(), 32, 32, out.data(), 40);
        return out;
    });
}

}  // namespace
}  // namespace hilcam
