#include "sensor/stray/point_halos.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "render/vocabulary/clones.h"
#include "render/vocabulary/units.h"
#include "sensor/convolution/psf.h"

namespace hilcam {

// The halo's profile. Within a given distance it continues as a parabola without a kink: the tangent of the
// halo as a function of the squared distance, which is below the halo.
struct HaloLaw {
    float scale, radius2, level2;  // g r / 2 pi, times electrons; squares of r and of that distance

    float at(float distance2) const {
        const float inside2 = level2 > distance2 ? level2 - distance2 : 0.0f;
        const float square = radius2 + distance2 + inside2;
        return scale / (square * std::sqrt(square)) * (1 + 1.5f * inside2 / square);
    }
};

namespace {

constexpr double kSeenHalo_e = 0.02;

// Places along x with a fixed step, relative to a source.
struct Places {
    float first_x, step, y_squared;
    std::size_t count;
    float squared(std::size_t i) const {
        const float x = first_x + step * static_cast<float>(i);
        return x * x + y_squared;
    }
};

HILCAM_CLONES void add(const HaloLaw& law, const Places& places, float* out) {
    for (std::size_t i = 0; i < places.count; ++i) out[i] += law.at(places.squared(i));
}

// Adds the difference between two laws.
HILCAM_CLONES void add_difference(const HaloLaw& law, const HaloLaw& other, const Places& places,
                                  std::size_t stride, float* out) {
    for (std::size_t i = 0; i < places.count; ++i) {
        const float squared = places.squared(i);
        out[i * stride] += law.at(squared) - other.at(squared);
    }
}

}  // namespace

PointHalos::PointHalos(const StrayLightConfig& stray, const ImageGeometry& detector)
    : glare_(stray.veiling_glare_fraction),
      radius_px_(stray.glare_radius_px),
      min_e_(kSeenHalo_e * PointSpread::kField_px * PointSpread::kField_px /
             share_beyond(0.5 * PointSpread::kField_px)),
      width_px_(detector.width_px),
      height_px_(detector.height_px),
      margin_px_(detector.guard_px + kNear_px),
      across_((width_px_ + 2 * margin_px_) / kCell_px + 1),
      down_((height_px_ + 2 * margin_px_) / kCell_px + 1),
      cells_(static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_)),
      nodes_across_(width_px_ / kNode_px + 2),
      nodes_(static_cast<std::size_t>(nodes_across_) * static_cast<std::size_t>(height_px_ / kNode_px + 2)) {
    lit_.reserve(cells_.size());
}

HaloLaw PointHalos::law_of(const Cell& cell, int level_px) const {
    return {static_cast<float>(glare_ * radius_px_ / (2 * kPi)) * cell.electrons,
            static_cast<float>(radius_px_ * radius_px_), static_cast<float>(level_px * level_px)};
}

double PointHalos::share(double distance_px) const {
    return static_cast<double>(
        law_of({1, 0, 0}, kLevel_px).at(static_cast<float>(distance_px * distance_px)));
}

double PointHalos::share_beyond(double distance_px) const {
    return glare_ * radius_px_ / std::hypot(radius_px_, distance_px);
}

void PointHalos::clear() {
    for (const std::uint32_t cell : lit_) cells_[cell] = {};
    lit_.clear();
}

void PointHalos::collect(Vec2d at_px, double electrons) {
    const double x = (at_px.x + margin_px_) / kCell_px, y = (at_px.y + margin_px_) / kCell_px;
    if (!(x >= 0 && y >= 0 && x < across_ && y < down_ && electrons > 0)) return;
    const auto number = static_cast<std::uint32_t>(static_cast<int>(y) * across_ + static_cast<int>(x));
    Cell& cell = cells_[number];
    if (cell.electrons == 0) lit_.push_back(number);
    cell.electrons += static_cast<float>(electrons);
    cell.at_x_px += static_cast<float>(electrons * at_px.x);
    cell.at_y_px += static_cast<float>(electrons * at_px.y);
}

void PointHalos::spread() {
    for (const std::uint32_t number : lit_) {
        Cell& cell = cells_[number];
        cell.at_x_px /= cell.electrons, cell.at_y_px /= cell.electrons;
    }
    const auto rows = static_cast<int>(nodes_.size()) / nodes_across_;
    tbb::parallel_for(tbb::blocked_range<int>(0, rows, 8), [&](const tbb::blocked_range<int>& range) {
        for (int j = range.begin(); j < range.end(); ++j) {
            float* const row = nodes_.data() + j * nodes_across_;
            std::fill_n(row, nodes_across_, 0.0f);
            for (const std::uint32_t number : lit_) {
                const Cell& cell = cells_[number];
                const float y = static_cast<float>(j * kNode_px) - cell.at_y_px;
                add(law_of(cell, kNear_px),
                    {-cell.at_x_px, kNode_px, y * y, static_cast<std::size_t>(nodes_across_)}, row);
            }
        }
    });
}

void PointHalos::add_to_row(int y, std::size_t first, std::size_t step, std::span<float> row) const {
    const float down = (static_cast<float>(y) + 0.5f) / kNode_px;
    const auto j = static_cast<std::size_t>(down);
    const float below = down - static_cast<float>(j);
    const float* const top = nodes_.data() + j * static_cast<std::size_t>(nodes_across_);
    const float* const bottom = top + nodes_across_;
    for (std::size_t x = first; x < row.size(); x += step) {
        const float along = (static_cast<float>(x) + 0.5f) / kNode_px;
        const auto i = static_cast<std::size_t>(along);
        const float right = along - static_cast<float>(i);
        row[x] += (1 - below) * ((1 - right) * top[i] + right * top[i + 1]) +
                  below * ((1 - right) * bottom[i] + right * bottom[i + 1]);
    }
    for (const std::uint32_t number : lit_) {
        const Cell& cell = cells_[number];
        const float dy = static_cast<float>(y) + 0.5f - cell.at_y_px;
        if (std::abs(dy) >= kNear_px) continue;
        // The first near pixel of the step, and one past the last.
        const float reach = std::sqrt(static_cast<float>(kNear_px * kNear_px) - dy * dy);
        const float from = std::max(0.0f, cell.at_x_px - reach - 0.5f),
                    to = std::min(static_cast<float>(row.size()), cell.at_x_px + reach + 0.5f);
        const auto before = static_cast<std::size_t>(from);
        const std::size_t begin = before <= first ? first : first + (before - first + step - 1) / step * step;
        if (!(to > static_cast<float>(begin))) continue;
        const std::size_t count = (static_cast<std::size_t>(to) - begin + step - 1) / step;
        add_difference(
            law_of(cell, kLevel_px), law_of(cell, kNear_px),
            {static_cast<float>(begin) + 0.5f - cell.at_x_px, static_cast<float>(step), dy * dy, count}, step,
            row.data() + begin);
    }
}

}  // namespace hilcam
