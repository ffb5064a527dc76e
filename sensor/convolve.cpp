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

#include "render/check.h"

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

}  // namespace

struct Convolver::Implementation {
    int width, height;
    std::size_t columns;  // complex columns that hold the half spectrum, rounded up to kColumns
    std::size_t stride;   // floats per row
    Block data;
    // Per thread. Transforms go from one block to another: the cost model's in-place plans are twice as slow.
    struct Scratch {
        Block row, columns, spectrum;
    };
    std::vector<Scratch> scratch;
    std::vector<float> mtf;  // [column][row], scaled by 1 / (width height)
    Plan row_forward, row_back, column_forward, column_back;

    float* row(int y) { return data.get() + static_cast<std::size_t>(y) * stride; }

    Implementation(int w, int h)
        : width(w),
          height(h),
          columns(static_cast<std::size_t>((w / 2 + 1 + kColumns - 1) / kColumns * kColumns)),
          stride(columns * 2),
          data(allocate(stride * static_cast<std::size_t>(h))) {
        const auto block = static_cast<std::size_t>(2 * kColumns * h);
        scratch.resize(static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()));
        for (Scratch& s : scratch) s = {allocate(stride), allocate(block), allocate(block)};
        // Every row and every block starts on a 64-byte line, as these do.
        const Scratch& s = scratch.front();
        row_forward.reset(fftwf_plan_dft_r2c_1d(w, row(0), as_complex(s.row.get()), kPlanning));
        row_back.reset(fftwf_plan_dft_c2r_1d(w, as_complex(s.row.get()), row(0), kPlanning));
        column_forward.reset(plan_columns(s.columns, s.spectrum, FFTW_FORWARD));
        column_back.reset(plan_columns(s.spectrum, s.columns, FFTW_BACKWARD));
        HILCAM_CHECK(row_forward && row_back && column_forward && column_back);
    }
    fftwf_plan plan_columns(const Block& from, const Block& to, int sign) const {
        return fftwf_plan_many_dft(1, &height, kColumns, as_complex(from.get()), nullptr, 1, height,
                                   as_complex(to.get()), nullptr, 1, height, sign, kPlanning);
    }

    Scratch& mine() {
        return scratch[static_cast<std::size_t>(tbb::this_task_arena::current_thread_index())];
    }

    void row_to_spectrum(int y) {
        Scratch& s = mine();
        fftwf_execute_dft_r2c(row_forward.get(), row(y), as_complex(s.row.get()));
        std::copy_n(s.row.get(), stride, row(y));
    }
    void row_to_image(int y) {
        Scratch& s = mine();
        std::copy_n(row(y), stride, s.row.get());
        fftwf_execute_dft_c2r(row_back.get(), as_complex(s.row.get()), row(y));
    }
    // Columns lie one behind the other in the scratch block.
    void filter_columns(std::size_t first) {
        Scratch& s = mine();
        const auto rows = static_cast<std::size_t>(height);
        using Complex = std::array<float, 2>;
        auto* columns_in = reinterpret_cast<Complex*>(s.columns.get());
        for (int y = 0; y < height; ++y) {
            const auto* in = reinterpret_cast<const Complex*>(row(y)) + first;
            for (std::size_t k = 0; k < kColumns; ++k)
                columns_in[k * rows + static_cast<std::size_t>(y)] = in[k];
        }
        fftwf_execute_dft(column_forward.get(), as_complex(s.columns.get()), as_complex(s.spectrum.get()));
        auto* spectrum = reinterpret_cast<Complex*>(s.spectrum.get());
        const float* factor = mtf.data() + first * rows;
        for (std::size_t i = 0; i < kColumns * rows; ++i) {
            spectrum[i][0] *= factor[i];
            spectrum[i][1] *= factor[i];
        }
        fftwf_execute_dft(column_back.get(), as_complex(s.spectrum.get()), as_complex(s.columns.get()));
        for (int y = 0; y < height; ++y) {
            auto* out = reinterpret_cast<Complex*>(row(y)) + first;
            for (std::size_t k = 0; k < kColumns; ++k)
                out[k] = columns_in[k * rows + static_cast<std::size_t>(y)];
        }
    }
};

Convolver::Convolver(int width, int height, const std::function<double(double, double)>& mtf)
    : width_(width), height_(height), implementation_(std::make_unique<Implementation>(width, height)) {
    Implementation& my = *implementation_;
    my.mtf.reserve(my.columns * static_cast<std::size_t>(height));
    const double scale = 1.0 / (static_cast<double>(width) * height);
    for (int x = 0; x < static_cast<int>(my.columns); ++x)
        for (int y = 0; y < height; ++y) {
            const double u = std::min(0.5, static_cast<double>(x) / width);
            const double v = static_cast<double>(y <= height / 2 ? y : y - height) / height;
            my.mtf.push_back(x <= width / 2 ? static_cast<float>(scale * mtf(u, std::abs(v))) : 0.0f);
        }
}
Convolver::~Convolver() = default;

std::span<float> Convolver::row(int y) { return {implementation_->row(y), static_cast<std::size_t>(width_)}; }
std::span<const float> Convolver::row(int y) const {
    return {implementation_->row(y), static_cast<std::size_t>(width_)};
}

void Convolver::run() {
    Implementation& my = *implementation_;
    const tbb::blocked_range<int> rows(0, height_, 16);
    tbb::parallel_for(rows, [&](const tbb::blocked_range<int>& range) {
        for (int y = range.begin(); y < range.end(); ++y) my.row_to_spectrum(y);
    });
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, my.columns / kColumns),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          for (std::size_t block = range.begin(); block < range.end(); ++block)
                              my.filter_columns(block * kColumns);
                      });
    tbb::parallel_for(rows, [&](const tbb::blocked_range<int>& range) {
        for (int y = range.begin(); y < range.end(); ++y) my.row_to_image(y);
    });
}

}  // namespace hilcam
