#include "sensor/stray/far_wings.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "render/vocabulary/units.h"

namespace hilcam {

FarWings::FarWings(double slope_px, const StrayLightConfig& stray, const ImageGeometry& geometry)
    : slope_px_(slope_px),
      glare_(stray.glare_radius_px > 0 ? stray.veiling_glare_fraction : 0),
      glare_radius_px_(stray.glare_radius_px),
      guard_px_(geometry.guard_px),
      across_(geometry.padded_width() / kCell_px + 2),
      down_(geometry.padded_height() / kCell_px + 2),
      cells_(static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_)),
      wings_(cells_.size()) {
    sources_.reserve(cells_.size());
    for (int j = 0; j < down_; ++j)
        for (int i = 0; i < across_; ++i)
            shares_.push_back(static_cast<float>(density(kCell_px * std::hypot(i, j))));
}

void FarWings::clear() {
    for (const Source& s : sources_) cells_[static_cast<std::size_t>(s.j * across_ + s.i)] = 0;
    sources_.clear();
}

void FarWings::collect(double x_px, double y_px, double electrons) {
    const int i = static_cast<int>(x_px + guard_px_) / kCell_px;
    const int j = static_cast<int>(y_px + guard_px_) / kCell_px;
    if (i < 0 || j < 0 || i >= across_ || j >= down_ || !(electrons > 0)) return;
    double& cell = cells_[static_cast<std::size_t>(j * across_ + i)];
    if (cell == 0) sources_.push_back({i, j, 0});
    cell += electrons;
}

void FarWings::spread() {
    for (Source& s : sources_) s.electrons = cells_[static_cast<std::size_t>(s.j * across_ + s.i)];
    tbb::parallel_for(tbb::blocked_range<int>(0, down_, 4), [&](const tbb::blocked_range<int>& range) {
        for (int j = range.begin(); j < range.end(); ++j) {
            float* row = wings_.data() + j * across_;
            std::fill_n(row, across_, 0.0f);
            for (const Source& s : sources_) {
                const float* share = shares_.data() + std::abs(j - s.j) * across_;
                const auto electrons = static_cast<float>(s.electrons);
                for (int i = 0; i < across_; ++i) row[i] += electrons * share[std::abs(i - s.i)];
            }
        }
    });
}

double FarWings::density(double distance_px) const {
    const double r = std::max<double>(distance_px, kLevel_px);
    const double halo = glare_radius_px_ * glare_radius_px_ + r * r;
    return slope_px_ / (4 * kPi * kPi * r * r * r) +
           glare_ * glare_radius_px_ / (2 * kPi * halo * std::sqrt(halo));
}

float FarWings::at(int x_px, int y_px) const {
    const float x = (static_cast<float>(x_px + guard_px_) + 0.5f) / kCell_px - 0.5f;
    const float y = (static_cast<float>(y_px + guard_px_) + 0.5f) / kCell_px - 0.5f;
    const int i = std::clamp(static_cast<int>(x), 0, across_ - 2);
    const int j = std::clamp(static_cast<int>(y), 0, down_ - 2);
    const float u = x - static_cast<float>(i), v = y - static_cast<float>(j);
    const float* top = wings_.data() + j * across_ + i;
    const float* bottom = top + across_;
    return (1 - v) * ((1 - u) * top[0] + u * top[1]) + v * ((1 - u) * bottom[0] + u * bottom[1]);
}

}  // namespace hilcam
