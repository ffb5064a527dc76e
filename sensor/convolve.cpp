#include "sensor/convolve.h"

#include <fftw3.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <vector>

#include "render/vocabulary/check.h"
#include "render/vocabulary/clones.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Plans come from the cost model, not from measured times: measured plans differ from run to run, and with
// them the last digit of every pixel.
constexpr unsigned kPlanning = FFTW_ESTIMATE;
// Columns copied out of the image together: 8 complex floats are one cache line.
constexpr int kColumns = 8;

struct FftwFree {
    void operator()(float* block) const { fftwf_free(block); }
};
using Block = std::unique_ptr<float, FftwFree>;
Block allocate(std::size_t floats) {
    Block block(fftwf_alloc_real(floats));
    if (!block) throw std::bad_alloc();
    std::fill_n(block.get(), floats, 0.0f);
    return block;
}
fftwf_complex* as_complex(float* floats) { return reinterpret_cast<fftwf_complex*>(floats); }

struct PlanDestroy {
    void operator()(fftwf_plan_s* plan) const { fftwf_destroy_plan(plan); }
};
using Plan = std::unique_ptr<fftwf_plan_s, PlanDestroy>;

// sin(pi x) / (pi x) to 2e-7: x less the nearest whole number, sin by its series to x^9.
[[gnu::always_inline]] inline float fast_sinc(float x) {
    const float whole = std::floor(x + 0.5f);
    const float r = (x - whole) * 3.14159265f;
    const float r2 = r * r;
    const float series =
        r * (1.0f + r2 * (-1.0f / 6 +
                          r2 * (1.0f / 120 + r2 * (-1.0f / 5040 + r2 * (1.0f / 362880 - r2 / 39916800)))));
    const float half = 0.5f * whole;
    const float odd = 2.0f * (half - std::floor(half));  // 1 for odd whole numbers, else 0
    const float sine = (1.0f - 2.0f * odd) * series;
    const float angle = x * 3.14159265f;
    return std::abs(x) < 1e-4f ? 1.0f : sine / angle;
}

// Columns of a spectrum times real or complex factors.
HILCAM_CLONES void multiply(std::array<float, 2>* spectrum, const float* factor, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        spectrum[i][0] *= factor[i];
        spectrum[i][1] *= factor[i];
    }
}
HILCAM_CLONES void multiply_complex(std::array<float, 2>* spectrum, const float* real, const float* imaginary,
                                    std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        const float re = spectrum[i][0], im = spectrum[i][1];
        spectrum[i][0] = re * real[i] - im * imaginary[i];
        spectrum[i][1] = re * imaginary[i] + im * real[i];
    }
}
HILCAM_CLONES void add(std::array<float, 2>* sum, const std::array<float, 2>* spectrum, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        sum[i][0] += spectrum[i][0];
        sum[i][1] += spectrum[i][1];
    }
}
// One column at frequency u [cycles/px]: along it v = y / height, negative beyond the middle.
HILCAM_CLONES void blur_column(std::array<float, 2>* spectrum, std::size_t height, float smear_u_cy,
                               float smear_y_px, float factor_u, const float* factor_v) {
    const float step = 1.0f / static_cast<float>(height);
    for (std::size_t y = 0; y < height; ++y) {
        const float v =
            step * static_cast<float>(static_cast<std::int32_t>(y)) - (y > height / 2 ? 1.0f : 0.0f);
        const float factor = factor_u * factor_v[y] * fast_sinc(smear_u_cy + v * smear_y_px);
        spectrum[y][0] *= factor;
        spectrum[y][1] *= factor;
    }
}

}  // namespace

struct Convolver::Implementation {
    // One layer's image and what its spectrum is multiplied by.
    struct Layer {
        Block data;
        std::vector<float> real,
            imaginary;  // [column][row], scaled by 1 / (width height); imaginary may be empty
    };
    int width, height;
    std::size_t columns;  // complex columns that hold the half spectrum, rounded up to kColumns
    std::size_t stride;   // floats per row
    std::vector<Layer> layers;
    // Per thread. Transforms go from one block to another: the cost model's in-place plans are twice as slow.
    struct Scratch {
        Block row, columns, spectrum, sum;
    };
    std::vector<Scratch> scratch;
    std::vector<float> axis_v;  // the blur's factor along the columns, smear apart
    Plan row_forward, row_back, column_forward, column_back;

    float* row(int y, std::size_t layer) {
        return layers[layer].data.get() + static_cast<std::size_t>(y) * stride;
    }

    Implementation(int w, int h, const std::vector<Transfer>& transfers)
        : width(w),
          height(h),
          columns(static_cast<std::size_t>((w / 2 + 1 + kColumns - 1) / kColumns * kColumns)),
          stride(columns * 2),
          axis_v(static_cast<std::size_t>(h), 1.0f) {
        for (const Transfer& transfer : transfers) add_layer(transfer);
        const auto block = static_cast<std::size_t>(2 * kColumns * h);
        scratch.resize(static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()));
        for (Scratch& s : scratch)
            s = {allocate(stride), allocate(block), allocate(block),
                 allocate(layers.size() > 1 ? block : std::size_t{1})};
        // Every row and every block starts on a 64-byte line, as these do.
        const Scratch& s = scratch.front();
        row_forward.reset(fftwf_plan_dft_r2c_1d(w, row(0, 0), as_complex(s.row.get()), kPlanning));
        row_back.reset(fftwf_plan_dft_c2r_1d(w, as_complex(s.row.get()), row(0, 0), kPlanning));
        column_forward.reset(plan_columns(s.columns, s.spectrum, FFTW_FORWARD));
        column_back.reset(plan_columns(s.spectrum, s.columns, FFTW_BACKWARD));
        HILCAM_CHECK(row_forward && row_back && column_forward && column_back);
    }
    fftwf_plan plan_columns(const Block& from, const Block& to, int sign) const {
        return fftwf_plan_many_dft(1, &height, kColumns, as_complex(from.get()), nullptr, 1, height,
                                   as_complex(to.get()), nullptr, 1, height, sign, kPlanning);
    }
    void add_layer(const Transfer& transfer) {
        Layer layer{allocate(stride * static_cast<std::size_t>(height)), {}, {}};
        const std::size_t count = columns * static_cast<std::size_t>(height);
        layer.real.reserve(count);
        layer.imaginary.reserve(count);
        const double scale = 1.0 / (static_cast<double>(width) * height);
        bool real = true;
        for (int x = 0; x < static_cast<int>(columns); ++x)
            for (int y = 0; y < height; ++y) {
                const double u = std::min(0.5, static_cast<double>(x) / width);
                const double v = static_cast<double>(y <= height / 2 ? y : y - height) / height;
                std::complex<double> value = x <= width / 2 ? scale * transfer(u, v) : 0.0;
                // At the image's own Nyquist frequency opposite frequencies are one.
                if (2 * x == width || 2 * y == height) value = value.real();
                layer.real.push_back(static_cast<float>(value.real()));
                layer.imaginary.push_back(static_cast<float>(value.imag()));
                real = real && layer.imaginary.back() == 0;
            }
        if (real) layer.imaginary = {};
        layers.push_back(std::move(layer));
    }

    Scratch& mine() {
        return scratch[static_cast<std::size_t>(tbb::this_task_arena::current_thread_index())];
    }

    void row_to_spectrum(int y, std::size_t layer) {
        Scratch& s = mine();
        fftwf_execute_dft_r2c(row_forward.get(), row(y, layer), as_complex(s.row.get()));
        std::copy_n(s.row.get(), stride, row(y, layer));
    }
    void row_to_image(int y) {
        Scratch& s = mine();
        std::copy_n(row(y, 0), stride, s.row.get());
        fftwf_execute_dft_c2r(row_back.get(), as_complex(s.row.get()), row(y, 0));
    }

    using Complex = std::array<float, 2>;
    static Complex* complex(const Block& block) { return reinterpret_cast<Complex*>(block.get()); }

    // Columns lie one behind the other in the scratch blocks.
    void filter_columns(std::size_t first, const FrameBlur& blur) {
        Scratch& s = mine();
        const std::size_t count = kColumns * static_cast<std::size_t>(height);
        for (std::size_t l = 0; l < layers.size(); ++l) {
            spectrum_of(first, l, s);
            // The spectra's sum ends up where the way back begins.
            if (layers.size() == 1) break;
            if (l == 0)
                std::copy_n(s.spectrum.get(), 2 * count, s.sum.get());
            else
                add(complex(s.sum), complex(s.spectrum), count);
        }
        if (layers.size() > 1) std::copy_n(s.sum.get(), 2 * count, s.spectrum.get());
        if (!blur.none()) blur_columns(first, blur, s);
        fftwf_execute_dft(column_back.get(), as_complex(s.spectrum.get()), as_complex(s.columns.get()));
        for (int y = 0; y < height; ++y) {
            auto* out = reinterpret_cast<Complex*>(row(y, 0)) + first;
            for (std::size_t k = 0; k < kColumns; ++k)
                out[k] =
                    complex(s.columns)[k * static_cast<std::size_t>(height) + static_cast<std::size_t>(y)];
        }
    }
    void spectrum_of(std::size_t first, std::size_t l, Scratch& s) {
        const auto rows = static_cast<std::size_t>(height);
        for (int y = 0; y < height; ++y) {
            const auto* in = reinterpret_cast<const Complex*>(row(y, l)) + first;
            for (std::size_t k = 0; k < kColumns; ++k)
                complex(s.columns)[k * rows + static_cast<std::size_t>(y)] = in[k];
        }
        fftwf_execute_dft(column_forward.get(), as_complex(s.columns.get()), as_complex(s.spectrum.get()));
        const Layer& layer = layers[l];
        const std::size_t at = first * rows, count = kColumns * rows;
        if (layer.imaginary.empty())
            multiply(complex(s.spectrum), layer.real.data() + at, count);
        else
            multiply_complex(complex(s.spectrum), layer.real.data() + at, layer.imaginary.data() + at, count);
    }
    // Beyond the half spectrum columns hold nothing.
    static double along_axis(const FrameBlur& blur, double frequency) {
        return blur.axis ? blur.axis(std::min(0.5, std::abs(frequency))) : 1.0;
    }
    void blur_columns(std::size_t first, const FrameBlur& blur, Scratch& s) {
        for (std::size_t k = 0; k < kColumns; ++k) {
            const double u = static_cast<double>(first + k) / width;
            const double a = kPi * u * blur.sigma_px.x;
            const double factor = std::exp(-2 * a * a) * along_axis(blur, u);
            blur_column(complex(s.spectrum) + k * static_cast<std::size_t>(height),
                        static_cast<std::size_t>(height), static_cast<float>(u * blur.smear_px.x),
                        static_cast<float>(blur.smear_px.y), static_cast<float>(factor), axis_v.data());
        }
    }
    void prepare(const FrameBlur& blur) {
        for (int y = 0; y < height; ++y) {
            const double v = static_cast<double>(y <= height / 2 ? y : y - height) / height;
            const double a = kPi * v * blur.sigma_px.y;
            axis_v[static_cast<std::size_t>(y)] =
                static_cast<float>(std::exp(-2 * a * a) * along_axis(blur, v));
        }
    }
};

int fft_size(int n) {
    for (int size = n + n % 2;; size += 2) {
        int rest = size;
        for (const int prime : {2, 3, 5, 7})
            while (rest % prime == 0) rest /= prime;
        if (rest == 1) return size;
    }
}

Convolver::Convolver(int width, int height, const std::vector<Transfer>& transfers)
    : width_(width),
      height_(height),
      implementation_(std::make_unique<Implementation>(width, height, transfers)) {}
Convolver::~Convolver() = default;
Convolver::Convolver(Convolver&&) noexcept = default;

int Convolver::layers() const { return static_cast<int>(implementation_->layers.size()); }
std::span<float> Convolver::row(int y, int layer) {
    return {implementation_->row(y, static_cast<std::size_t>(layer)), static_cast<std::size_t>(width_)};
}
std::span<const float> Convolver::row(int y, int layer) const {
    return {implementation_->row(y, static_cast<std::size_t>(layer)), static_cast<std::size_t>(width_)};
}

void Convolver::run(const FrameBlur& blur) {
    Implementation& my = *implementation_;
    if (!blur.none()) my.prepare(blur);
    const tbb::blocked_range<int> rows(0, height_, 16);
    tbb::parallel_for(rows, [&](const tbb::blocked_range<int>& range) {
        for (std::size_t layer = 0; layer < my.layers.size(); ++layer)
            for (int y = range.begin(); y < range.end(); ++y) my.row_to_spectrum(y, layer);
    });
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, my.columns / kColumns),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          for (std::size_t block = range.begin(); block < range.end(); ++block)
                              my.filter_columns(block * kColumns, blur);
                      });
    tbb::parallel_for(rows, [&](const tbb::blocked_range<int>& range) {
        for (int y = range.begin(); y < range.end(); ++y) my.row_to_image(y);
    });
}

}  // namespace hilcam
