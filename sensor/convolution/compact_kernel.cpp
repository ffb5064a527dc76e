#include "sensor/convolution/compact_kernel.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "render/vocabulary/clones.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr int kGrid = 64;  // number of frequencies along an axis at which functions are compared

// Returns the weights for a real, even function of one frequency, by the trapezoidal rule over one period.
std::vector<double> weights_of(const std::function<double(double)>& transfer, int radius) {
    std::vector<double> weights;
    for (int x = -radius; x <= radius; ++x) {
        double sum = 0;
        for (int i = 0; i < kGrid; ++i) {
            const double f = (i - kGrid / 2) / static_cast<double>(kGrid);
            sum += transfer(std::abs(f)) * std::cos(2 * kPi * f * x) / kGrid;
        }
        weights.push_back(sum);
    }
    // Normalises, so that uniform light is unchanged.
    const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (double& w : weights) w /= all;
    return weights;
}

double transfer_of(const std::vector<float>& weights, double f) {
    const int radius = static_cast<int>(weights.size() / 2);
    double sum = 0;
    for (int x = -radius; x <= radius; ++x)
        sum += static_cast<double>(weights[static_cast<std::size_t>(x + radius)]) * std::cos(2 * kPi * f * x);
    return sum;
}

double largest_error(const CompactKernel& kernel, const Transfer& transfer) {
    double most = 0;
    for (int j = -kGrid / 2; j <= kGrid / 2; ++j)
        for (int i = 0; i <= kGrid / 2; ++i) {
            const double u = i / static_cast<double>(kGrid), v = j / static_cast<double>(kGrid);
            most = std::max(most, std::abs(transfer(u, v) - kernel.at(u, v)));
        }
    return most;
}

// Computes `count` outputs from an input that begins `radius` before them.
HILCAM_CLONES void along(const float* in, std::size_t count, const float* weights, std::size_t taps,
                         float* out) {
    for (std::size_t x = 0; x < count; ++x) out[x] = weights[0] * in[x];
    for (std::size_t k = 1; k < taps; ++k) {
        const float w = weights[k];
        for (std::size_t x = 0; x < count; ++x) out[x] += w * in[x + k];
    }
}
HILCAM_CLONES void add_weighted(const float* in, std::size_t count, float weight, float* out) {
    for (std::size_t x = 0; x < count; ++x) out[x] += weight * in[x];
}

}  // namespace

std::optional<CompactKernel> CompactKernel::find(const Transfer& transfer, int width, int height) {
    for (int radius = 1; radius <= kMaxRadius; ++radius) {
        const auto u_part = weights_of([&](double u) { return transfer(u, 0).real(); }, radius);
        const auto v_part = weights_of([&](double v) { return transfer(0, v).real(); }, radius);
        CompactKernel kernel;
        kernel.across_.assign(u_part.begin(), u_part.end());
        kernel.down_.assign(v_part.begin(), v_part.end());
        if (largest_error(kernel, transfer) > kMaxError) continue;
        kernel.filtered_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
        kernel.lit_.resize(static_cast<std::size_t>(height));
        return kernel;
    }
    return std::nullopt;
}

double CompactKernel::at(double u, double v) const { return transfer_of(across_, u) * transfer_of(down_, v); }

void CompactKernel::run(Convolver& image) {
    const auto width = static_cast<std::size_t>(image.width()), taps = across_.size();
    const auto reach = static_cast<std::size_t>(radius());
    const tbb::blocked_range<int> rows(0, image.height(), 16);
    const auto filtered = [&](int y) { return filtered_.data() + static_cast<std::size_t>(y) * width; };
    tbb::parallel_for(rows, [&](const tbb::blocked_range<int>& range) {
        for (int y = range.begin(); y < range.end(); ++y) {
            const std::span<const float> row = image.row(y);
            const bool lit = std::any_of(row.begin(), row.end(), [](float v) { return v != 0; });
            lit_[static_cast<std::size_t>(y)] = lit ? 1 : 0;
            if (!lit || width < taps) continue;
            std::fill_n(filtered(y), reach, 0.0f);
            along(row.data(), width - 2 * reach, across_.data(), taps, filtered(y) + reach);
            std::fill_n(filtered(y) + width - reach, reach, 0.0f);
        }
    });
    tbb::parallel_for(rows, [&](const tbb::blocked_range<int>& range) {
        for (int y = range.begin(); y < range.end(); ++y) {
            const std::span<float> out = image.row(y);
            std::fill(out.begin(), out.end(), 0.0f);
            for (int k = -radius(); k <= radius(); ++k) {
                const int from = y + k;
                if (from < 0 || from >= image.height() || !lit_[static_cast<std::size_t>(from)]) continue;
                add_weighted(filtered(from), width, down_[static_cast<std::size_t>(k + radius())],
                             out.data());
            }
        }
    });
}

}  // namespace hilcam
