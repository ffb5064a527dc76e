#include "sensor/convolution/bright_pixels.h"

#include <algorithm>

namespace hilcam {
namespace {

constexpr float kBrightWells = 10;
constexpr std::size_t kMaxBright = 4096;  // largest number in one channel

}  // namespace

BrightPixels::BrightPixels(const Grid& grid, double full_well_e, int channels,
                           const std::vector<float>& illumination)
    : grid_(grid), limit_e_(kBrightWells * static_cast<float>(full_well_e)), illumination_(illumination) {
    pixels_.reserve(kMaxBright * static_cast<std::size_t>(channels));
}

float BrightPixels::take_out(const Picture& picture) {
    const std::size_t before = pixels_.size();
    float limit_e = limit_e_;
    while (!find_over(picture, limit_e, before)) limit_e *= 10;
    return limit_e;
}

// Returns false, without removing light, when there are too many.
bool BrightPixels::find_over(const Picture& picture, float limit_e, std::size_t before) {
    std::size_t count = 0;
    const auto each_over = [&](const auto& use) {
        for (int y = 0; y < grid_.height; ++y) {
            if (picture.row_peaks_e[static_cast<std::size_t>(y)] <= limit_e) continue;
            const std::span<float> row = picture.charge_e.row(y);
            for (int x = 0; x < grid_.width; ++x)
                if (row[static_cast<std::size_t>(x)] > limit_e) use(x, y, row[static_cast<std::size_t>(x)]);
        }
    };
    each_over([&](int, int, float) { ++count; });
    if (count > kMaxBright) return false;
    pixels_.resize(before);
    const double part = 1.0 / (grid_.oversampling * grid_.oversampling);
    each_over([&](int x, int y, float& charge_e) {
        pixels_.push_back({place_of(picture, x, y, charge_e), part * static_cast<double>(charge_e - limit_e),
                           picture.channel});
        charge_e = limit_e;
    });
    return true;
}

// Returns the centroid of a pixel's light, as far as its moments tell [px of the detector's frame].
Vec2d BrightPixels::place_of(const Picture& picture, int x, int y, float charge_e) const {
    const Vec2d middle_px{detector_px(x), detector_px(y)};
    const SubpixelLight* const moments = picture.moments;
    const auto at = static_cast<std::size_t>(x);
    if (!moments || moments->unknown(x, y) || moments->kinds(y)[at] == SubpixelKind::kSmooth)
        return middle_px;
    const float lens =
        illumination_[static_cast<std::size_t>(y) * static_cast<std::size_t>(grid_.width) + at];
    const double share_per_rate =
        picture.exposure_s * static_cast<double>(lens) / static_cast<double>(charge_e);
    constexpr double kHalfsMiddle_px = 0.25;  // distance of the centre of a half from the pixel's centre
    const auto way_px = [&](int difference) {
        const double share =
            share_per_rate * static_cast<double>(moments->row(y, difference, picture.channel)[at]);
        return kHalfsMiddle_px * std::clamp(share, -1.0, 1.0);
    };
    return {middle_px.x + way_px(0), middle_px.y + way_px(1)};
}

}  // namespace hilcam
