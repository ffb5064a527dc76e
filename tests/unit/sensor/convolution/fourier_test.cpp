#include "sensor/convolution/fourier.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "sensor/convolution/convolve.h"
#include "tests/support/vector_widths.h"

namespace hilcam {
namespace {

// Room on a 64-byte line.
class Floats {
  public:
    explicit Floats(std::size_t count) : floats_(count + 16) {
        while (reinterpret_cast<std::uintptr_t>(floats_.data() + first_) % 64 != 0) ++first_;
    }
    float* data() { return floats_.data() + first_; }

  private:
    std::vector<float> floats_;
    std::size_t first_ = 0;
};

// Any value, different for each pixel.
float pixel(std::size_t x, std::size_t y) {
    return static_cast<float>((x * 37 + y * 101 + x * y % 13) % 64) - 20;
}

// The definition, in double.
std::complex<double> sum_of(std::size_t width, std::size_t height, std::size_t u, std::size_t v) {
    std::complex<double> sum = 0;
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x) {
            const double turns = static_cast<double>(u * x % width) / static_cast<double>(width) +
                                 static_cast<double>(v * y % height) / static_cast<double>(height);
            sum += std::polar<double>(pixel(x, y), -2 * std::numbers::pi * turns);
        }
    return sum;
}

class EverySize : public testing::TestWithParam<std::array<int, 2>> {};
// One and two pixels, odd and even, every factor and pairs of one, fewer and more than a vector's lanes.
INSTANTIATE_TEST_SUITE_P(Fourier, EverySize,
                         testing::Values(std::array{1, 1}, std::array{2, 2}, std::array{1, 7},
                                         std::array{24, 3}, std::array{35, 16}, std::array{56, 45},
                                         std::array{64, 70}, std::array{90, 98}));

TEST_P(EverySize, IsTheSumThatDefinesIt) {
    const auto [w, h] = GetParam();
    const auto width = static_cast<std::size_t>(w), height = static_cast<std::size_t>(h);
    const auto fourier = make_plane_fourier(w, h);
    const std::size_t stride = PlaneFourier::stride(w), lanes = fourier->lanes();
    Floats plane(stride * height), block(PlaneFourier::block_floats(w)),
        room(PlaneFourier::room_floats(w, h));
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x) plane.data()[y * stride + x] = pixel(x, y);
    for (std::size_t x = 0; x < width; x += PlaneFourier::kMaxLanes)
        fourier->columns_forward(plane.data(), x, room.data());
    const double tolerance = 1e-6 * 64 * w * h;
    for (std::size_t v = 0; v <= height / 2; v += lanes) {
        fourier->rows_forward(plane.data(), v, block.data(), room.data());
        for (std::size_t u = 0; u < width; ++u)
            for (std::size_t k = 0; k < lanes && v + k <= height / 2; ++k) {
                const std::complex<double> expected = sum_of(width, height, u, v + k);
                ASSERT_NEAR(block.data()[2 * lanes * u + k], expected.real(), tolerance) << u << ' ' << v + k;
                ASSERT_NEAR(block.data()[2 * lanes * u + lanes + k], expected.imag(), tolerance)
                    << u << ' ' << v + k;
            }
        fourier->rows_back(block.data(), v, plane.data(), room.data());
    }
    for (std::size_t x = 0; x < width; x += PlaneFourier::kMaxLanes)
        fourier->columns_back(plane.data(), x, room.data());
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < stride; ++x)
            ASSERT_NEAR(plane.data()[y * stride + x], x < width ? pixel(x, y) * static_cast<float>(w * h) : 0,
                        tolerance)
                << x << ' ' << y;
}

// The error against the definition in double: each of log2(n) halvings rounds to 2^-24 of the values' root
// mean square at most. The lengths are those of cameras' frames with their guard bands.
TEST(Fourier, ALineIsRightToARoundingAPass) {
    for (const int length : {1080, 2048, 2100, 2592}) {
        const auto height = static_cast<std::size_t>(length);
        const auto fourier = make_plane_fourier(1, length);
        const std::size_t stride = PlaneFourier::stride(1);
        Floats plane(stride * height), room(PlaneFourier::room_floats(1, length));
        for (std::size_t y = 0; y < height; ++y) plane.data()[y * stride] = pixel(0, y);
        fourier->columns_forward(plane.data(), 0, room.data());
        double squares = 0, sum = 0;
        for (std::size_t v = 0; v <= height / 2; v += 7) {
            const std::complex<double> expected = sum_of(1, height, 0, v);
            const std::size_t real = v == 0 ? 0 : 2 * v - 1;
            squares += std::pow(plane.data()[real * stride] - expected.real(), 2);
            sum += std::norm(expected);
            if (v == 0 || 2 * v == height) continue;
            squares += std::pow(plane.data()[2 * v * stride] - expected.imag(), 2);
        }
        const double passes = std::log2(length);
        EXPECT_LT(std::sqrt(squares / sum), passes * 0x1p-24) << length;
        EXPECT_GT(squares, 0) << length;  // the two are not the same sum
    }
}

TEST(Fourier, ASizeWithAnotherFactorIsRefused) {
    EXPECT_THROW(make_plane_fourier(22, 16), std::runtime_error);
    EXPECT_THROW(make_plane_fourier(16, 26), std::runtime_error);
}

// A frame must not depend on the processor that computes it.
TEST(Fourier, GivesTheSameBitsWithVectorsOfAnyWidth) {
    const auto blurred = [] {
        Convolver picture(90, 84,
                          {[](double u, double v) { return std::polar(1 - u * u - v * v, u); },
                           [](double u, double v) { return std::complex(1 / (1 + u * u + v * v)); }});
        for (int layer = 0; layer < 2; ++layer)
            for (int y = 0; y < 84; ++y)
                for (std::size_t x = 0; x < 90; ++x)
                    picture.row(y, layer)[x] = pixel(x, static_cast<std::size_t>(y));
        picture.run({{3.2, -1.7}, {0.3, 0.5}});
        std::vector<float> all;
        for (int y = 0; y < 84; ++y) all.insert(all.end(), picture.row(y).begin(), picture.row(y).end());
        return all;
    };
    expect_same_by_any_width(blurred, {HWY_AVX2, HWY_SSE4, HWY_SSSE3});
}

TEST(Fourier, SquaresGoThereAndBack) {
    constexpr std::size_t size = 12;
    std::vector<std::complex<float>> square(size * size);
    for (std::size_t y = 0; y < size; ++y)
        for (std::size_t x = 0; x < size; ++x) square[y * size + x] = pixel(x, y);
    fourier_forward(square, size);
    std::vector<std::complex<float>> half;
    for (std::size_t v = 0; v < size; ++v)
        for (std::size_t u = 0; u <= size / 2; ++u) {
            const auto expected = sum_of(size, size, u, v);
            EXPECT_NEAR(std::abs(std::complex<double>(square[v * size + u]) - expected), 0, 1e-2);
            half.push_back(square[v * size + u]);
        }
    std::vector<float> back(size * size);
    real_from_half_spectrum(half, size, back);
    for (std::size_t y = 0; y < size; ++y)
        for (std::size_t x = 0; x < size; ++x)
            EXPECT_NEAR(back[y * size + x], pixel(x, y) * size * size, 1e-2);
}

}  // namespace
}  // namespace hilcam
