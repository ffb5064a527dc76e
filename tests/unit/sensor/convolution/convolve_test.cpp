#include "sensor/convolution/convolve.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/vocabulary/units.h"
#include "sensor/convolution/compact_kernel.h"
#include "sensor/mtf.h"
#include "tests/support/cameras.h"

namespace hilcam {
namespace {

Transfer gaussian(double sigma_px) {
    return [=](double u, double v) { return std::complex<double>(gaussian_mtf(std::hypot(u, v), sigma_px)); };
}

TEST(CompactKernel, IsFoundForSmallGaussiansOnly) {
    const auto kernel = CompactKernel::find(gaussian(1.0), 64, 64);
    ASSERT_TRUE(kernel);
    for (const double u : {0.0, 0.1, 0.3, 0.5})
        for (const double v : {0.0, 0.2, 0.45})
            EXPECT_NEAR(kernel->at(u, v), gaussian(1.0)(u, v).real(), CompactKernel::kMaxError)
                << u << ' ' << v;
    EXPECT_NEAR(kernel->at(0, 0), 1, 1e-6);
    EXPECT_FALSE(CompactKernel::find(gaussian(4.0), 64, 64));  // wide
    EXPECT_FALSE(CompactKernel::find(gaussian(0.3), 64, 64));  // passes its image's Nyquist frequency
    // A cone is no product.
    EXPECT_FALSE(CompactKernel::find(
        [](double u, double v) { return std::complex<double>(std::max(0.0, 1 - 2 * std::hypot(u, v))); }, 64,
        64));
    // Nor is what moves the picture sideways.
    EXPECT_FALSE(CompactKernel::find(
        [](double u, double v) { return std::polar(gaussian_mtf(std::hypot(u, v), 1), -2 * kPi * 0.25 * u); },
        64, 64));
}

TEST(CompactKernel, GivesTheFftsPicture) {
    for (const double sigma_px : {1.0, 1.3}) {
        Convolver by_fft(100, 80, {gaussian(sigma_px)}), by_kernel(100, 80, {gaussian(sigma_px)});
        auto kernel = CompactKernel::find(gaussian(sigma_px), 100, 80);
        ASSERT_TRUE(kernel);
        for (Convolver* c : {&by_fft, &by_kernel})
            for (int y = 30; y < 50; ++y)
                for (std::size_t x = 40; x < 70; ++x)
                    c->row(y)[x] = 100 + static_cast<float>((x * 7 + static_cast<std::size_t>(y) * 5) % 31);
        by_fft.run();
        kernel->run(by_kernel);
        for (int y = 0; y < 80; ++y)
            for (std::size_t x = 0; x < 100; ++x)
                // The error of every frequency at most, times the picture's largest value.
                ASSERT_NEAR(by_fft.row(y)[x], by_kernel.row(y)[x], 130 * 2 * CompactKernel::kMaxError)
                    << x << ' ' << y;
    }
}

TEST(CompactKernel, ACameraChoosesItByItself) {
    CameraModel blurred = gaussian_camera(1.2);
    blurred.pixel_aperture_m = {1e-7, 1e-7};
    EXPECT_GT(Bench(blurred).chain.kernel_radius(), 0);
    EXPECT_EQ(Bench(camera_64()).chain.kernel_radius(), 0);
}

TEST(Convolver, SizesAreSmooth) {
    EXPECT_EQ(fft_size(1080), 1080);
    EXPECT_EQ(fft_size(2648), 2688);  // 8 x 331; 2^7 x 3 x 7
    EXPECT_EQ(fft_size(1), 2);
    EXPECT_EQ(fft_size(4999), 5000);
}

// Blur at run time is the same as blur in the transfer function.
TEST(Convolver, MotionBlurIsAFactorOfTheSpectrum) {
    const Vec2d smear_px{3.4, -1.2}, sigma_px{0.5, 0.9};
    const Transfer blurred = [&](double u, double v) {
        return std::complex<double>(sinc(u * smear_px.x + v * smear_px.y) * gaussian_mtf(u, sigma_px.x) *
                                    gaussian_mtf(v, sigma_px.y));
    };
    Convolver at_run(96, 70, {gaussian(0)}), planned(96, 70, {blurred});
    for (Convolver* c : {&at_run, &planned})
        for (std::size_t x = 40; x < 50; ++x) c->row(35)[x] = 1000;
    at_run.run({smear_px, sigma_px});
    planned.run();
    for (int y = 0; y < 70; ++y)
        for (std::size_t x = 0; x < 96; ++x)
            ASSERT_NEAR(at_run.row(y)[x], planned.row(y)[x], 2e-3) << x << ' ' << y;
}

TEST(Convolver, LayersAddUp) {
    Convolver both(64, 64, {gaussian(1), gaussian(2)}), one(64, 64, {gaussian(1)}),
        two(64, 64, {gaussian(2)});
    one.row(20)[20] = both.row(20, 0)[20] = 100;
    two.row(40)[30] = both.row(40, 1)[30] = 50;
    both.run(), one.run(), two.run();
    for (int y = 0; y < 64; ++y)
        for (std::size_t x = 0; x < 64; ++x)
            ASSERT_NEAR(both.row(y)[x], one.row(y)[x] + two.row(y)[x], 1e-4) << x << ' ' << y;
}

// Odd and even sizes, and a shift by a whole pixel written as phases.
TEST(Convolver, ComplexFunctionsMoveThePicture) {
    for (const int width : {64, 75}) {
        Convolver shift(width, 35,
                        {[](double u, double v) { return std::polar(1.0, -2 * kPi * (2 * u + v)); }});
        shift.row(10)[20] = 8;
        shift.run();
        EXPECT_NEAR(shift.row(11)[22], 8, 0.3);  // the Nyquist column of an even width has no phase
        EXPECT_NEAR(shift.row(10)[20], 0, 0.3);
    }
}

}  // namespace
}  // namespace hilcam
