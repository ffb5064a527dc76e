#include "render/frame/adaptive_sampler.h"

#include <algorithm>
#include <limits>

#include "render/frame/finite_light.h"

namespace hilcam {

AdaptiveSampler::AdaptiveSampler() : pass_(kMax), mean_(kMax) {}

std::span<const Spectrum> AdaptiveSampler::trace(const FrameContext& frame, const PixelBox& box,
                                                 int samples_per_axis, const NoiseBudget& budget,
                                                 PathModel& paths, TileStats& stats) {
    begin(box);
    const int n2 = samples_per_axis * samples_per_axis;
    for (int pass = 0;; ++pass) {
        std::fill_n(pass_.begin(), pixels(), Spectrum{});
        Tile tile{frame, box, samples_per_axis, {pass_.data(), pixels()}, stats, clusters_};
        tile.scattered = true;
        tile.first_sample = static_cast<std::uint16_t>(pass * n2);
        tile.wanted = pass > 0 ? wanted_.data() : nullptr;
        paths.trace(tile);
        stats.not_finite += leave_out_not_finite(tile.pixels);
        take_pass(1 / static_cast<float>(n2), budget.noise, frame.bins);
        // The choice after the last pass is what is reported.
        if (!choose(budget) || pass + 1 == budget.max_passes) break;
    }
    count(stats);
    return {mean_.data(), pixels()};
}

void AdaptiveSampler::begin(const PixelBox& box) {
    width_ = box.x1 - box.x0, height_ = box.y1 - box.y0;
    std::fill_n(mean_.begin(), pixels(), Spectrum{});
    std::fill_n(mean_e_.begin(), pixels(), 0.0f);
    std::fill_n(squares_e2_.begin(), pixels(), 0.0f);
    std::fill_n(passes_.begin(), pixels(), std::uint16_t{0});
    std::fill_n(wanted_.begin(), pixels(), std::uint8_t{1});
}

void AdaptiveSampler::take_pass(float share, const PixelNoise& noise, int bins) {
    for (std::size_t i = 0; i < pixels(); ++i) {
        if (!wanted_[i]) continue;
        const float k = ++passes_[i];
        const Spectrum value = share * pass_[i];
        for (int b = 0; b < bins; ++b) mean_[i][b] += (value[b] - mean_[i][b]) / k;
        const float electrons = noise.electrons(value, bins);
        const float before = electrons - mean_e_[i];
        mean_e_[i] += before / k;
        squares_e2_[i] += before * (electrons - mean_e_[i]);
    }
}

// True when any pixel is wanted.
bool AdaptiveSampler::choose(const NoiseBudget& budget) {
    const auto share = static_cast<float>(budget.share);
    const float allowed = share * share * budget.noise.averaged;
    bool any = false;
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) {
            const auto i = static_cast<std::size_t>(y * width_ + x);
            const float variance_e2 = pass_variance(x, y) / static_cast<float>(passes_[i]);
            wanted_[i] = variance_e2 > allowed * budget.noise.variance_e2(mean_e_[i]) ? 1 : 0;
            any = any || wanted_[i];
        }
    return any;
}

// V of the header, of the pixels about (x, y) that the part has.
float AdaptiveSampler::pass_variance(int x, int y) const {
    float squares_e2 = 0, sum_e = 0, sum_e2 = 0;
    int freedoms = 0, neighbours = 0;
    const auto here = static_cast<std::size_t>(y * width_ + x);
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height_ - 1); ++j)
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width_ - 1); ++i) {
            const auto at = static_cast<std::size_t>(j * width_ + i);
            squares_e2 += squares_e2_[at];
            freedoms += passes_[at] - 1;
            // Against this pixel's value: sums of squares of large numbers would cancel.
            const float difference_e = mean_e_[at] - mean_e_[here];
            sum_e += difference_e, sum_e2 += difference_e * difference_e;
            ++neighbours;
        }
    if (passes_[here] == 1) {
        // A part of a single pixel tells nothing.
        if (neighbours == 1) return std::numeric_limits<float>::infinity();
        const auto count = static_cast<float>(neighbours);
        return std::max(0.0f, (sum_e2 - sum_e * sum_e / count) / (count - 1));
    }
    const float own_e2 = squares_e2_[here] / static_cast<float>(passes_[here] - 1);
    return std::max(own_e2, squares_e2 / static_cast<float>(freedoms));
}

void AdaptiveSampler::count(TileStats& stats) const {
    for (std::size_t i = 0; i < pixels(); ++i)
        if (mean_e_[i] > 0) {
            ++stats.lit_px;
            if (!wanted_[i]) ++stats.within_budget_px;
        }
}

}  // namespace hilcam
