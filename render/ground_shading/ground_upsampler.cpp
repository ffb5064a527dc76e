#include "render/ground_shading/ground_upsampler.h"

#include <algorithm>
#include <array>

namespace hilcam {
namespace {

constexpr int kStep_px = GroundUpsampler::kStep_px;
constexpr int kRing = 2;  // places around a box that its pixels need
constexpr int kMaxPlaces = RadianceImage::kBlock_px / kStep_px + 2 * kRing;

// Keys' weights of four places for a point a quarter of the way from the second to the third; reversed: three
// quarters.
constexpr std::array<float, 4> kQuarter = {-0.0703125f, 0.8671875f, 0.2265625f, -0.0234375f};

// Interpolate between four values from at[0] on, `apart` values apart.
float near_second(const float* at, int apart) {
    return kQuarter[0] * at[0] + kQuarter[1] * at[apart] + kQuarter[2] * at[2 * apart] +
           kQuarter[3] * at[3 * apart];
}
float near_third(const float* at, int apart) {
    return kQuarter[3] * at[0] + kQuarter[2] * at[apart] + kQuarter[1] * at[2 * apart] +
           kQuarter[0] * at[3 * apart];
}

int places(int px) { return (px + kStep_px - 1) / kStep_px; }

RadianceImage room_for(const RadianceImage& picture) {
    const int width = places(picture.width()), height = places(picture.height());
    const auto responses = picture.responses();
    return responses.empty() ? RadianceImage(width, height, picture.planes())
                             : RadianceImage(width, height, {responses.begin(), responses.end()});
}

}  // namespace

GroundUpsampler::GroundUpsampler(const RadianceImage& picture)
    : light_(room_for(picture)),
      tiles_across_((light_.width() + kTile - 1) / kTile),
      tiles_down_((light_.height() + kTile - 1) / kTile),
      known_(index(0, tiles_down_), 0) {}

bool GroundUpsampler::has_room_for(const RadianceImage& picture) const {
    return light_.width() == places(picture.width()) && light_.height() == places(picture.height()) &&
           light_.planes() == picture.planes() &&
           std::ranges::equal(light_.responses(), picture.responses(), {}, &Spectrum::bin, &Spectrum::bin);
}

bool GroundUpsampler::knows(const PixelBox& b) const {
    const int x1 = std::min((b.x1 - 1) / kTile, tiles_across_ - 1),
              y1 = std::min((b.y1 - 1) / kTile, tiles_down_ - 1);
    for (int y = std::max(0, b.y0 / kTile); y <= y1; ++y)
        for (int x = std::max(0, b.x0 / kTile); x <= x1; ++x)
            if (!known_[index(x, y)]) return false;
    return true;
}

// A pixel's middle is a quarter of the way between two places, or three quarters.
bool GroundUpsampler::give(const PixelBox& box, RadianceImage& picture) const {
    const int x0 = box.x0 / kStep_px - kRing, y0 = box.y0 / kStep_px - kRing;
    const int across = places(box.x1) + kRing - x0, down = places(box.y1) + kRing - y0;
    if (!knows({x0, y0, x0 + across, y0 + down})) return false;
    std::array<float, kMaxPlaces * kMaxPlaces>
        in;  // places around the box; the outermost ones are repeated outside the picture
    std::array<float, 2 * kMaxPlaces * kMaxPlaces> lines;  // the picture's lines, at the places' columns
    for (int plane = 0; plane < picture.planes(); ++plane) {
        for (int y = 0; y < down; ++y) {
            const auto row = light_.row(std::clamp(y0 + y, 0, light_.height() - 1), plane);
            for (int x = 0; x < across; ++x)
                in[static_cast<std::size_t>(y * kMaxPlaces + x)] =
                    row[static_cast<std::size_t>(std::clamp(x0 + x, 0, light_.width() - 1))];
        }
        for (int y = 0; y + 2 * kRing < down; ++y) {
            const float* const above = in.data() + y * kMaxPlaces;
            float* const upper = lines.data() + 2 * y * kMaxPlaces;
            for (int x = 0; x < across; ++x) upper[x] = near_third(above + x, kMaxPlaces);
            for (int x = 0; x < across; ++x)
                upper[kMaxPlaces + x] = near_second(above + kMaxPlaces + x, kMaxPlaces);
        }
        for (int y = box.y0; y < box.y1; ++y) {
            const float* const line = lines.data() + (y - box.y0) * kMaxPlaces;
            std::array<float, 2 * kMaxPlaces> out;
            for (int x = 0; x + 2 * kRing < across; ++x) {
                out[static_cast<std::size_t>(2 * x)] = std::max(0.0f, near_third(line + x, 1));
                out[static_cast<std::size_t>(2 * x + 1)] = std::max(0.0f, near_second(line + x + 1, 1));
            }
            std::copy_n(out.data(), box.x1 - box.x0, picture.row(y, plane).data() + box.x0);
        }
    }
    return true;
}

}  // namespace hilcam
