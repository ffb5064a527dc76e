#include "emulator/zoo/surface_blocks.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr int kJudgedBlock_px = 4;

// A pixel in the layers.
struct Place {
    std::uint32_t part = 0;
    Vec3f normal, position_m;
};
Place place_at(const TruthLayers& layers, int x, int y) {
    const auto i = static_cast<std::size_t>(x);
    const auto vector_of = [&](const auto& image) {
        return Vec3f{image.row(y, 0)[i], image.row(y, 1)[i], image.row(y, 2)[i]};
    };
    return {layers.part.row(y)[i], vector_of(layers.normal), vector_of(layers.position_m)};
}

bool continues(const Place& a, const Place& b) {
    constexpr float kCosine = 0.98f;  // cosine of 11.5 degrees
    constexpr float kRise = 0.3f;     // sine of 17.5 degrees
    if (a.part != b.part || dot(a.normal, b.normal) < kCosine) return false;
    const Vec3f way = b.position_m - a.position_m;
    return std::abs(dot(way, a.normal)) <= kRise * length(way);
}

bool is_smooth(const TruthLayers& layers, int x, int y) {
    const Place here = place_at(layers, x, y);
    if (here.part == 0) return false;
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
            if ((dx != 0 || dy != 0) && !continues(here, place_at(layers, x + dx, y + dy))) return false;
    return true;
}

bool is_object(std::uint32_t id) { return id != kSkyId && id < kFirstBodyId; }

// Sums over the pixels of a block.
struct BlockSums {
    double light_e = 0, off_e = 0, error_e2 = 0;
};
BlockSums sums_of(const ElectronImage& picture, const KnownPicture& reference, int x0, int y0) {
    BlockSums sums;
    for (int y = y0; y < y0 + kJudgedBlock_px; ++y)
        for (int x = x0; x < x0 + kJudgedBlock_px; ++x) {
            const auto i = static_cast<std::size_t>(x);
            const auto mean_e = static_cast<double>(reference.mean.row(y)[i]);
            const auto error_e = static_cast<double>(reference.error.row(y)[i]);
            sums.light_e += mean_e - static_cast<double>(reference.dark.row(y)[i]);
            sums.off_e += static_cast<double>(picture.row(y)[i]) - mean_e;
            sums.error_e2 += error_e * error_e;
        }
    return sums;
}

bool all_smooth(const SurfacePixels& surface, int x0, int y0) {
    for (int y = y0; y < y0 + kJudgedBlock_px; ++y)
        for (int x = x0; x < x0 + kJudgedBlock_px; ++x)
            if (!surface.is_smooth(x, y)) return false;
    return true;
}

}  // namespace

SurfacePixels surface_pixels(const TruthLayers& layers) {
    SurfacePixels out;
    out.width = layers.object.width(), out.height = layers.object.height();
    out.smooth.assign(layers.object.pixels(), 0);
    out.near_object.assign(layers.object.pixels(), 0);
    const auto row = static_cast<std::size_t>(out.width);
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) {
            if (!is_object(layers.object.row(y)[static_cast<std::size_t>(x)])) continue;
            const bool inside = x > 0 && y > 0 && x + 1 < out.width && y + 1 < out.height;
            if (inside && is_smooth(layers, x, y))
                out.smooth[static_cast<std::size_t>(y) * row + static_cast<std::size_t>(x)] = 1;
            const int x0 = std::max(0, x - SurfacePixels::kNear_px);
            const int x1 = std::min(out.width, x + SurfacePixels::kNear_px + 1);
            for (int v = std::max(0, y - SurfacePixels::kNear_px);
                 v < std::min(out.height, y + SurfacePixels::kNear_px + 1); ++v)
                std::fill_n(out.near_object.begin() +
                                static_cast<std::ptrdiff_t>(static_cast<std::size_t>(v) * row) + x0,
                            x1 - x0, std::uint8_t{1});
        }
    return out;
}

BlockCounts block_counts(const ElectronImage& picture, const KnownPicture& reference,
                         const SurfacePixels& surface, const SensorNoise& noise) {
    HILCAM_CHECK(picture.width() == surface.width && picture.height() == surface.height &&
                 picture.pixels() == reference.mean.pixels());
    constexpr double kLit_sigma = 5, kKnown = 1.0 / 40;
    constexpr double kPixels = kJudgedBlock_px * kJudgedBlock_px;
    BlockCounts counts;
    for (int y = 0; y + kJudgedBlock_px <= surface.height; y += kJudgedBlock_px)
        for (int x = 0; x + kJudgedBlock_px <= surface.width; x += kJudgedBlock_px) {
            if (!all_smooth(surface, x, y)) continue;
            const BlockSums sums = sums_of(picture, reference, x, y);
            const auto dark_e = static_cast<double>(reference.dark.row(y)[static_cast<std::size_t>(x)]);
            if (sums.light_e <= kPixels * kLit_sigma * noise.sigma_e(dark_e, dark_e)) continue;
            if (std::sqrt(sums.error_e2) > kKnown * sums.light_e) {
                ++counts.unknown;
                continue;
            }
            const double off = std::abs(sums.off_e) / sums.light_e;
            ++counts.judged;
            counts.over_10 += off > 0.10 ? 1 : 0;
            counts.over_25 += off > 0.25 ? 1 : 0;
        }
    return counts;
}

}  // namespace hilcam
