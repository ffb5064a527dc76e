#pragma once
// Discrete Fourier transforms in single precision, with the passes of PocketFFT (M. Reinecke, BSD-3). Forward
// uses exp(-2 pi i ...). Neither direction scales, so both together multiply by the number of values. Sizes
// are products of 2, 3, 5 and 7, as fft_size() of convolve.h returns them.
//
// A PlaneFourier transforms a real plane to its half spectrum and back, with as many lines side by side as a
// vector has lanes:
//   columns_forward  transforms columns in place. Row 0 of the plane then holds frequency v = 0, rows 2 v - 1
//                    and 2 v the real and the imaginary part of frequency v, and the last row of an even
//                    height the real part of height / 2.
//   rows_forward     copies `lanes()` frequencies v, v + 1, ... from the plane into a block [width][real,
//                    imaginary][lanes] and transforms them along x.
//   multiply, blur   work on such a block.
//   rows_back, columns_back   undo rows_forward and columns_forward.
// A line's result depends on no other line, and not on the processor: every level of vector instructions
// gives the same bits.

#include <complex>
#include <cstddef>
#include <memory>
#include <span>

namespace hilcam {

// A factor for frequency (u, v) of a block: along_u[x] along_v[v] sinc(smear_x u + smear_y v), with u from
// -1/2 to 1/2 [cycles/px].
struct SpectrumBlur {
    std::span<const float> along_u;  // one for each x of the width
    std::span<const float> along_v;  // one for each v, up to a whole number of lanes
    float smear_x_px, smear_y_px;
};

class PlaneFourier {
  public:
    static constexpr std::size_t kMaxLanes = 16;
    // Returns the floats from one row of the plane to the next. They are whole vectors, and not a power of
    // two, which would put all rows of a column into the same few cache lines.
    static std::size_t stride(int width);
    // Return the floats of a block, and of the scratch memory that every transform needs; both must be
    // 64-byte aligned.
    static std::size_t block_floats(int width);
    static std::size_t room_floats(int width, int height);

    virtual ~PlaneFourier() = default;
    virtual std::size_t lanes() const = 0;
    // Transform columns first .. first + kMaxLanes - 1 of a 64-byte aligned plane. Loop.
    virtual void columns_forward(float* plane, std::size_t first, float* room) const = 0;
    virtual void columns_back(float* plane, std::size_t first, float* room) const = 0;
    // Transform frequencies v .. v + lanes() - 1. Frequencies above height / 2 are zero, and are dropped on
    // the way back. Loop.
    virtual void rows_forward(const float* plane, std::size_t v, float* block, float* room) const = 0;
    virtual void rows_back(float* block, std::size_t v, float* plane, float* room) const = 0;
    // These work on a block; factors are [width][lanes]. Loop.
    virtual void multiply(float* block, const float* real) const = 0;
    virtual void multiply(float* block, const float* real, const float* imaginary) const = 0;
    virtual void add(float* sum, const float* block) const = 0;
    virtual void blur(float* block, std::size_t v, const SpectrumBlur& blur) const = 0;
};

// Returns the transform for the widest vectors of this processor. Throws std::runtime_error for a size with
// another prime factor.
std::unique_ptr<PlaneFourier> make_plane_fourier(int width, int height);

// Transforms a square of size x size values in place. Owner thread; allocates.
void fourier_forward(std::span<std::complex<float>> square, std::size_t size);
// Computes the real square [size][size] from its half spectrum [size][size / 2 + 1]. Owner thread; allocates.
void real_from_half_spectrum(std::span<const std::complex<float>> spectrum, std::size_t size,
                             std::span<float> square);

}  // namespace hilcam
