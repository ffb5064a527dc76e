#include "sensor/convolution/fourier.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sensor/convolution/fourier.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Suppresses a warning about calling conventions: PocketFFT passes vectors by value, but all its functions
// are inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

#include <pocketfft/pocketfft-inl.h>

HWY_BEFORE_NAMESPACE();

namespace hilcam {
namespace HWY_NAMESPACE {

namespace lines = pocketfft::HWY_NAMESPACE;

constexpr std::size_t kLanes = HWY_LANES(float);
static_assert(PlaneFourier::kMaxLanes % kLanes == 0);
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));
using Complex = lines::cmplx<Lanes>;

HWY_INLINE Lanes load(const float* from) {
    Lanes lanes;
    std::memcpy(&lanes, from, sizeof lanes);
    return lanes;
}
HWY_INLINE void store(const Lanes& lanes, float* to) { std::memcpy(to, &lanes, sizeof lanes); }

// Interleaves the lower or upper halves of two vectors.
template <std::size_t kFirst, std::size_t... kIndex>
HWY_INLINE Lanes interleaved(const Lanes& a, const Lanes& b, std::index_sequence<kIndex...>) {
    return __builtin_shufflevector(a, b, (kFirst + kIndex / 2 + kIndex % 2 * kLanes)...);
}

// Transposes: each pass pairs vector i with the one half a square further; after log2(kLanes) passes rows are
// columns.
HWY_INLINE void transpose(Lanes (&square)[kLanes]) {
    constexpr std::make_index_sequence<kLanes> all;
    for (std::size_t pass = 1; pass < kLanes; pass *= 2) {
        Lanes paired[kLanes];
        for (std::size_t i = 0; i < kLanes / 2; ++i) {
            paired[2 * i] = interleaved<0>(square[i], square[i + kLanes / 2], all);
            paired[2 * i + 1] = interleaved<kLanes / 2>(square[i], square[i + kLanes / 2], all);
        }
        std::copy_n(paired, kLanes, square);
    }
}

// Returns sin(pi x) / (pi x) to 2e-7: x minus the nearest whole number, sine by its series to x^11.
HWY_INLINE float fast_sinc(float x) {
    const float whole = std::floor(x + 0.5f);
    const float r = (x - whole) * 3.14159265f;
    const float r2 = r * r;
    const float series =
        r * (1.0f + r2 * (-1.0f / 6 +
                          r2 * (1.0f / 120 + r2 * (-1.0f / 5040 + r2 * (1.0f / 362880 - r2 / 39916800)))));
    const float half = 0.5f * whole;
    const float odd = 2.0f * (half - std::floor(half));  // 1 for odd whole numbers, else 0
    const float sine = (1.0f - 2.0f * odd) * series;
    return std::abs(x) < 1e-4f ? 1.0f : sine / (x * 3.14159265f);
}

class LanesFourier final : public PlaneFourier {
  public:
    LanesFourier(int width, int height)
        : width_(static_cast<std::size_t>(width)),
          height_(static_cast<std::size_t>(height)),
          stride_(stride(width)),
          along_x_(width_),
          along_y_(height_) {}

    std::size_t lanes() const override { return kLanes; }

    void columns_forward(float* plane, std::size_t first, float* room) const override {
        columns(plane, first, room, true);
    }
    void columns_back(float* plane, std::size_t first, float* room) const override {
        columns(plane, first, room, false);
    }

    void rows_forward(const float* plane, std::size_t v, float* block, float* room) const override {
        auto* values = reinterpret_cast<Complex*>(block);
        for (std::size_t x = 0; x < width_; x += kLanes) {
            Lanes real[kLanes], imaginary[kLanes];
            for (std::size_t k = 0; k < kLanes; ++k) {
                real[k] = v + k > height_ / 2 ? Lanes{} : load(plane + real_row(v + k) * stride_ + x);
                imaginary[k] = is_complex(v + k) ? load(plane + 2 * (v + k) * stride_ + x) : Lanes{};
            }
            transpose(real), transpose(imaginary);
            for (std::size_t k = 0; k < kLanes; ++k) values[x + k] = {real[k], imaginary[k]};
        }
        along_x_.exec(values, reinterpret_cast<Complex*>(room), true);
    }
    void rows_back(float* block, std::size_t v, float* plane, float* room) const override {
        auto* values = reinterpret_cast<Complex*>(block);
        along_x_.exec(values, reinterpret_cast<Complex*>(room), false);
        // Beyond the width the plane stays zero, because it takes part in the transforms of columns.
        for (std::size_t x = width_; x % kLanes != 0; ++x) values[x] = {Lanes{}, Lanes{}};
        for (std::size_t x = 0; x < width_; x += kLanes) {
            Lanes real[kLanes], imaginary[kLanes];
            for (std::size_t k = 0; k < kLanes; ++k)
                real[k] = values[x + k].r, imaginary[k] = values[x + k].i;
            transpose(real), transpose(imaginary);
            for (std::size_t k = 0; k < kLanes && v + k <= height_ / 2; ++k) {
                store(real[k], plane + real_row(v + k) * stride_ + x);
                if (is_complex(v + k)) store(imaginary[k], plane + 2 * (v + k) * stride_ + x);
            }
        }
    }

    void multiply(float* block, const float* real) const override {
        auto* values = reinterpret_cast<Complex*>(block);
        for (std::size_t x = 0; x < width_; ++x) {
            const Lanes factor = load(real + x * kLanes);
            values[x].r *= factor, values[x].i *= factor;
        }
    }
    void multiply(float* block, const float* real, const float* imaginary) const override {
        auto* values = reinterpret_cast<Complex*>(block);
        for (std::size_t x = 0; x < width_; ++x) {
            const Lanes re = load(real + x * kLanes), im = load(imaginary + x * kLanes);
            const Complex value = values[x];
            values[x].r = value.r * re - value.i * im;
            values[x].i = value.r * im + value.i * re;
        }
    }
    void add(float* sum, const float* block) const override {
        for (std::size_t i = 0; i < 2 * kLanes * width_; ++i) sum[i] += block[i];
    }
    void blur(float* block, std::size_t v, const SpectrumBlur& blur) const override {
        const float step_u = 1.0f / static_cast<float>(width_), step_v = 1.0f / static_cast<float>(height_);
        for (std::size_t x = 0; x < width_; ++x) {
            const float u = step_u * static_cast<float>(x) - (x > width_ / 2 ? 1.0f : 0.0f);
            const float smear_u = u * blur.smear_x_px;
            float* const values = block + 2 * kLanes * x;
            for (std::size_t k = 0; k < kLanes; ++k) {
                const float smear = smear_u + step_v * static_cast<float>(v + k) * blur.smear_y_px;
                const float factor = blur.along_u[x] * blur.along_v[v + k] * fast_sinc(smear);
                values[k] *= factor;
                values[kLanes + k] *= factor;
            }
        }
    }

  private:
    std::size_t width_, height_, stride_;
    lines::cfftp<float> along_x_;
    lines::rfftp<float> along_y_;

    static std::size_t real_row(std::size_t v) { return v == 0 ? 0 : 2 * v - 1; }
    bool is_complex(std::size_t v) const { return v != 0 && 2 * v < height_; }

    void columns(float* plane, std::size_t first, float* room, bool forward) const {
        auto* values = reinterpret_cast<Lanes*>(room);
        for (std::size_t x = first; x < first + kMaxLanes; x += kLanes) {
            for (std::size_t y = 0; y < height_; ++y) values[y] = load(plane + y * stride_ + x);
            along_y_.exec(values, values + height_, forward);
            for (std::size_t y = 0; y < height_; ++y) store(values[y], plane + y * stride_ + x);
        }
    }
};

std::unique_ptr<PlaneFourier> make(int width, int height) {
    return std::make_unique<LanesFourier>(width, height);
}

}  // namespace HWY_NAMESPACE
}  // namespace hilcam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hilcam {
namespace {

std::size_t whole_vectors(int count) {
    constexpr std::size_t most = PlaneFourier::kMaxLanes;
    return (static_cast<std::size_t>(count) + most - 1) / most * most;
}

namespace lines = pocketfft::HWY_NAMESPACE;

// `count` lines of `length` values. next_line: distance between the first values of two lines; next_value:
// between two values of a line.
struct Lines {
    std::size_t count, next_line, length, next_value;
};

void transform(std::complex<float>* values, const Lines& of, bool forward) {
    const lines::cfftp<float> plan(of.length);
    std::vector<lines::cmplx<float>> line(of.length), room(of.length);
    for (std::size_t i = 0; i < of.count; ++i) {
        std::complex<float>* const first = values + i * of.next_line;
        for (std::size_t k = 0; k < of.length; ++k)
            line[k] = {first[k * of.next_value].real(), first[k * of.next_value].imag()};
        plan.exec(line.data(), room.data(), forward);
        for (std::size_t k = 0; k < of.length; ++k) first[k * of.next_value] = {line[k].r, line[k].i};
    }
}

}  // namespace

std::size_t PlaneFourier::stride(int width) {
    const std::size_t floats = whole_vectors(width);
    return floats % 64 == 0 ? floats + kMaxLanes : floats;
}
std::size_t PlaneFourier::block_floats(int width) { return 2 * kMaxLanes * whole_vectors(width); }
std::size_t PlaneFourier::room_floats(int width, int height) {
    return std::max(block_floats(width), 2 * kMaxLanes * static_cast<std::size_t>(height));
}

HWY_EXPORT(make);

std::unique_ptr<PlaneFourier> make_plane_fourier(int width, int height) {
    return HWY_DYNAMIC_DISPATCH(make)(width, height);
}

void fourier_forward(std::span<std::complex<float>> square, std::size_t size) {
    transform(square.data(), {size, 1, size, size}, true);
    transform(square.data(), {size, size, size, 1}, true);
}

void real_from_half_spectrum(std::span<const std::complex<float>> spectrum, std::size_t size,
                             std::span<float> square) {
    const std::size_t half = size / 2 + 1;
    std::vector<std::complex<float>> rows(spectrum.begin(), spectrum.end());
    transform(rows.data(), {half, 1, size, half}, false);
    const lines::rfftp<float> plan(size);
    std::vector<float> room(size);
    for (std::size_t y = 0; y < size; ++y) {
        const std::complex<float>* const row = rows.data() + y * half;
        // PocketFFT's order: the real part of frequency 0, then both parts of each following frequency; the
        // last one of an even size has no imaginary part.
        float* const line = square.data() + y * size;
        line[0] = row[0].real();
        for (std::size_t i = 1; i < size; ++i)
            line[i] = i % 2 == 1 ? row[(i + 1) / 2].real() : row[i / 2].imag();
        plan.exec(line, room.data(), false);
    }
}

}  // namespace hilcam
#endif
