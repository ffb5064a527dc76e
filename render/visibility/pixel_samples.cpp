#include "render/visibility/pixel_samples.h"

#include <array>
#include <vector>

namespace hilcam {
namespace {

// Returns the sample of some of sixteen that is nearest to a place.
int nearest_to(std::uint32_t samples, Vec2f place) {
    float least = 4;
    int nearest = 0;
    for (std::uint32_t rest = samples; rest; rest &= rest - 1) {
        const int i = std::countr_zero(rest);
        const float dx = sample_x(i) - place.x, dy = sample_y(i) - place.y;
        if (dx * dx + dy * dy < least) least = dx * dx + dy * dy, nearest = i;
    }
    return nearest;
}

// For each set of sixteen samples the sum of their places, and the one next to their middle: by themselves, as they are
// asked for each fragment and fit a cache.
struct Sixteen {
    std::vector<Vec2f> sum;
    std::vector<std::uint8_t> nearest;
};
const Sixteen kSixteen = [] {
    Sixteen out{std::vector<Vec2f>(0x10000u), std::vector<std::uint8_t>(0x10000u)};
    for (std::uint32_t samples = 1; samples < out.sum.size(); ++samples) {
        Vec2f sum{};
        for (std::uint32_t rest = samples; rest; rest &= rest - 1) {
            const int i = std::countr_zero(rest);
            sum.x += sample_x(i), sum.y += sample_y(i);
        }
        const float share = 1 / static_cast<float>(std::popcount(samples));
        out.sum[samples] = sum;
        out.nearest[samples] = static_cast<std::uint8_t>(nearest_to(samples, {share * sum.x, share * sum.y}));
    }
    return out;
}();

std::uint32_t of_quarter(SampleMask samples, int quarter) {
    return static_cast<std::uint32_t>(samples >> (kVisibilitySamples * quarter)) & kAllSamples;
}

}  // namespace

Vec2f PixelSamples::middle(SampleMask samples) const {
    if (samples == all()) return {0.5f, 0.5f};
    if (quarters_ == 1) return place(kSixteen.nearest[samples]);
    Vec2f sum{};
    for (int q = 0; q < 4; ++q) {
        const std::uint32_t part = of_quarter(samples, q);
        const auto count = static_cast<float>(std::popcount(part));
        sum.x += (count * static_cast<float>(q % 2) + kSixteen.sum[part].x) / 2;
        sum.y += (count * static_cast<float>(q / 2) + kSixteen.sum[part].y) / 2;
    }
    const float share = 1 / static_cast<float>(std::popcount(samples));
    const Vec2f middle{share * sum.x, share * sum.y};
    // Mostly the sample about the middle is one of them.
    const int column = static_cast<int>(8 * middle.x), row = static_cast<int>(8 * middle.y);
    const int about = kVisibilitySamples * (2 * (row / 4) + column / 4) + 4 * (row % 4) + column % 4;
    if (samples >> about & 1u) return place(about);
    float least = 4;
    Vec2f out{};
    for (int q = 0; q < 4; ++q) {
        const std::uint32_t part = of_quarter(samples, q);
        if (part == 0) continue;
        const Vec2f within{2 * middle.x - static_cast<float>(q % 2),
                           2 * middle.y - static_cast<float>(q / 2)};
        const Vec2f at = place(kVisibilitySamples * q + nearest_to(part, within));
        const float dx = at.x - middle.x, dy = at.y - middle.y;
        if (dx * dx + dy * dy < least) least = dx * dx + dy * dy, out = at;
    }
    return out;
}

HalfShares PixelSamples::halves(SampleMask samples) const {
    // The crossed difference has the upper left and the lower right.
    constexpr SampleMask kRight = 0xCCCC, kLower = 0xFF00, kCrossed = 0xCC33;
    constexpr SampleMask kRightFine = 0xFFFF0000FFFF0000, kLowerFine = 0xFFFFFFFF00000000,
                         kCrossedFine = 0xFFFF00000000FFFF;
    if (samples == all()) return {};
    const int count = std::popcount(samples);
    const auto share = [&](SampleMask half) {
        return static_cast<float>(2 * std::popcount(samples & half) - count) / static_cast<float>(count);
    };
    if (quarters_ == 1) return {share(kRight), share(kLower), share(kCrossed)};
    return {share(kRightFine), share(kLowerFine), share(kCrossedFine)};
}

int next_sample(const PixelSamples& grid, SampleMask& rest, SampleMask all) {
    constexpr std::array<std::uint8_t, kVisibilitySamples> kOrder{0, 10, 2, 8, 5, 15, 7, 13,
                                                                  1, 11, 3, 9, 4, 14, 6, 12};
    if (rest == 0) rest = all;
    for (const std::uint8_t place : kOrder)
        if (const SampleMask here = rest & grid.about(place)) {
            rest &= ~here;
            return std::countr_zero(here);
        }
    return 0;
}

}  // namespace hilcam
