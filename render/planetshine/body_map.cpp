#include "render/planetshine/body_map.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace hilcam {

BodyMap::BodyMap() {
    for (int level = 0; level < kLevels; ++level) {
        const auto across = static_cast<std::size_t>((kMaxSide >> level) + 2);
        texels_[static_cast<std::size_t>(level)].resize(across * across);
    }
}

BodyMap::Place BodyMap::place_of(int x, int y) const {
    const float scale = 2 * radius_ / static_cast<float>(side_);
    const float px = (static_cast<float>(x) + 0.5f) * scale - radius_;
    const float py = (static_cast<float>(y) + 0.5f) * scale - radius_;
    const float squared = px * px + py * py;
    // Snyder, eq. 24-4 turned round: 2 (1 - cosine) is the distance's square.
    const float across = std::sqrt(std::max(0.0f, 1 - 0.25f * squared));
    return {frame_.to_world({px * across, py * across, 1 - 0.5f * squared}), squared <= radius_ * radius_};
}

void BodyMap::place(const Background& background, Vec3f axis, float one_minus_cosine, float narrowest_alpha) {
    frame_ = Frame(axis);
    radius_ = std::sqrt(2 * one_minus_cosine);
    side_ = kMinSide, levels_ = 1;
    const float wanted_rad = std::max(0.5f * narrowest_alpha, kNarrowest_rad);
    while (side_ < kMaxSide && 2 * radius_ > wanted_rad * static_cast<float>(side_)) side_ *= 2, ++levels_;
    const float texel_rad = 2 * radius_ / static_cast<float>(side_);
    texel_sr_ = texel_rad * texel_rad;
    for (int level = 0; level < levels_; ++level)
        std::fill_n(texels_[static_cast<std::size_t>(level)].begin(),
                    index(level, side_ >> level, side_ >> level) + 1, Spectrum{});
    tbb::parallel_for(tbb::blocked_range<int>(0, side_), [&](const tbb::blocked_range<int>& rows) {
        for (int y = rows.begin(); y < rows.end(); ++y)
            for (int x = 0; x < side_; ++x) {
                const Place place = place_of(x, y);
                if (!place.inside) continue;
                Spectrum weight;
                weight.bin.fill(1);
                background.add_bodies({}, to_double(place.dir), weight, texels_[0][index(0, x, y)],
                                      static_cast<double>(texel_rad));
            }
    });
    for (int level = 1; level < levels_; ++level) halve(level);
}

void BodyMap::halve(int level) {
    for (int y = 0; y < side_ >> level; ++y)
        for (int x = 0; x < side_ >> level; ++x) {
            const Spectrum* above = texel(level - 1, 2 * x, 2 * y);
            const Spectrum* below = texel(level - 1, 2 * x, 2 * y + 1);
            texels_[static_cast<std::size_t>(level)][index(level, x, y)] =
                0.25f * ((above[0] + above[1]) + (below[0] + below[1]));
        }
}

Spectrum BodyMap::about(Vec3f dir, float spread_sr) const {
    int level = 0;
    for (float sr = 4 * texel_sr_; level + 1 < levels_ && sr <= spread_sr; sr *= 4) ++level;
    const Vec3f local = frame_.to_local(dir);
    if (!(local.z > -0.999f)) return {};
    // Snyder, eq. 24-2.
    const float side = static_cast<float>(side_ >> level);
    const float scale = 0.5f * side / radius_ * std::sqrt(2 / (1 + local.z));
    const float x = 0.5f * side - 0.5f + scale * local.x, y = 0.5f * side - 0.5f + scale * local.y;
    if (!(x > -1 && y > -1 && x < side && y < side)) return {};
    const float left = std::floor(x), top = std::floor(y);
    const float u = x - left, v = y - top;
    const Spectrum* above = texel(level, static_cast<int>(left), static_cast<int>(top));
    const Spectrum* below = texel(level, static_cast<int>(left), static_cast<int>(top) + 1);
    return (1 - v) * ((1 - u) * above[0] + u * above[1]) + v * ((1 - u) * below[0] + u * below[1]);
}

}  // namespace hilcam
