#include "sensor/convolve.h"

#include <fftw3.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <vector>

#include "render/check.h"

namespace hilcam {
namespace {

// Columns transformed side by side: 8 complex floats are one cache line.
constexpr int kColumns = 8;

struct FftwFree {
    void operator()(float* block) const { fftwf_free(block); }
};
struct PlanDestroy {
    void operator()(fftwf_plan_s* plan) const { fftwf_destroy_plan(plan); }
};
using Plan = std::unique_ptr<fftwf_plan_s, PlanDestroy>;

}  // namespace

struct Convolver::Implementation {
    int width, height;
    int columns;         // complex columns that hold the half spectrum, rounded up to kColumns
    std::size_t stride;  // floats per row
    std::unique_ptr<float, FftwFree> data;
    std::vector<float> mtf;  // [column][row], scaled by 1 / (width height)
    Plan row_forward, row_back, column_forward, column_back;

    float* row(int y) { return data.get() + static_cast<std::size_t>(y) * stride; }
    fftwf_complex* complex_row(int y) { return reinterpret_cast<fftwf_complex*>(row(y)); }

    Implementation(int w, int h)
        : width(w),
          height(h),
          columns((w / 2 + 1 + kColumns - 1) / kColumns * kColumns),
          stride(static_cast<std::size_t>(columns) * 2),
          data(fftwf_alloc_real(stride * static_cast<std::size_t>(h))) {
        if (!data) throw std::bad_alloc();
        // The row plans run on every row, the column plans on every block: all start on 64-byte lines like
        // row 0.
        row_forward.reset(fftwf_plan_dft_r2c_1d(w, row(0), complex_row(0), FFTW_MEASURE));
        row_back.reset(fftwf_plan_dft_c2r_1d(w, complex_row(0), row(0), FFTW_MEASURE));
        column_forward.reset(fftwf_plan_many_dft(1, &height, kColumns, complex_row(0), nullptr, columns, 1,
                                                 complex_row(0), nullptr, columns, 1, FFTW_FORWARD,
                                                 FFTW_MEASURE));
        column_back.reset(fftwf_plan_many_dft(1, &height, kColumns, complex_row(0), nullptr, columns, 1,
                                              complex_row(0), nullptr, columns, 1, FFTW_BACKWARD,
                                              FFTW_MEASURE));
        HILCAM_CHECK(row_forward && row_back && column_forward && column_back);
        std::fill_n(data.get(), stride * static_cast<std::size_t>(h), 0.0f);
    }

    void filter_columns(int first) {
        fftwf_complex* block = complex_row(0) + first;
        fftwf_execute_dft(column_forward.get(), block, block);
        for (int y = 0; y < height; ++y) {
            float* values = row(y) + 2 * first;
            const float* factor =
                mtf.data() + (static_cast<std::size_t>(first / kColumns) * static_cast<std::size_t>(height) +
                              static_cast<std::size_t>(y)) *
                                 kColumns;
            for (int k = 0; k < kColumns; ++k) {
                values[2 * k] *= factor[k];
                values[2 * k + 1] *= factor[k];
            }
        }
        fftwf_execute_dft(column_back.get(), block, block);
    }
};

Convolver::Convolver(int width, int height, const std::function<double(double, double)>& mtf)
    : width_(width), height_(height), implementation_(std::make_unique<Implementation>(width, height)) {
    Implementation& my = *implementation_;
    my.mtf.resize(static_cast<std::size_t>(my.columns) * static_cast<std::size_t>(height));
    const double scale = 1.0 / (static_cast<double>(width) * height);
    std::size_t at = 0;
    for (int first = 0; first < my.columns; first += kColumns)
        for (int y = 0; y < height; ++y)
            for (int x = first; x < first + kColumns; ++x) {
                const double u = std::min(0.5, static_cast<double>(x) / width);
                const double v = static_cast<double>(y <= height / 2 ? y : y - height) / height;
                my.mtf[at++] = x <= width / 2 ? static_cast<float>(scale * mtf(u, std::abs(v))) : 0.0f;
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
        for (int y = range.begin(); y < range.end(); ++y)
            fftwf_execute_dft_r2c(my.row_forward.get(), my.row(y), my.complex_row(y));
    });
    tbb::parallel_for(tbb::blocked_range<int>(0, my.columns / kColumns),
                      [&](const tbb::blocked_range<int>& range) {
                          for (int block = range.begin(); block < range.end(); ++block)
                              my.filter_columns(block * kColumns);
                      });
    tbb::parallel_for(rows, [&](const tbb::blocked_range<int>& range) {
        for (int y = range.begin(); y < range.end(); ++y)
            fftwf_execute_dft_c2r(my.row_back.get(), my.complex_row(y), my.row(y));
    });
}

}  // namespace hilcam
