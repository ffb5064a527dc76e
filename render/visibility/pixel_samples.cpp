#include "render/visibility/pixel_samples.h"

#include <array>
#include <vector>

namespace hilcam {
namespace {

// The positions of samples on a grid, summed from the number of samples with each digit of the column and the
// row.
struct Lines {
    int columns, rows;  // sums
};
Lines lines_of(SampleMask samples) {
    const auto count = [&](SampleMask with) { return std::popcount(samples & with); };
    return {count(0xAAAAAAAAAAAAAAAA) + 2 * count(0xCCCCCCCCCCCCCCCC) + 4 * count(0xFFFF0000FFFF0000),
            count(0xF0F0F0F0F0F0F0F0) + 2 * count(0xFF00FF00FF00FF00) + 4 * count(0xFFFFFFFF00000000)};
}

Vec2f mean_of(SampleMask samples, int across) {
    const int count = std::popcount(samples);
    const Lines lines = lines_of(samples);
    const float share = 1 / static_cast<float>(count);
    const auto mean = [&](int sum) {
        return share *
               ((static_cast<float>(sum) + 0.5f * static_cast<float>(count)) / static_cast<float>(across));
    };
    return {mean(lines.columns), mean(lines.rows)};
}

// Returns the place of the sample nearest to a place.
Vec2f nearest_to(const PixelSamples& grid, SampleMask samples, Vec2f place) {
    float least = 4;
    Vec2f nearest{};
    for (SampleMask rest = samples; rest; rest &= rest - 1) {
        const Vec2f at = grid.place(std::countr_zero(rest));
        const float dx = at.x - place.x, dy = at.y - place.y;
        if (dx * dx + dy * dy < least) least = dx * dx + dy * dy, nearest = at;
    }
    return nearest;
}

// For each set of sixteen samples, the one nearest to their middle; tabulated because each fragment needs it.
const std::vector<std::uint8_t> kNearestOfSixteen = [] {
    const PixelSamples grid(kVisibilitySamplesAcross);
    std::vector<std::uint8_t> out(0x10000u);
    for (std::uint32_t samples = 1; samples < out.size(); ++samples) {
        const Vec2f at = nearest_to(grid, samples, mean_of(samples, kVisibilitySamplesAcross));
        out[samples] = static_cast<std::uint8_t>(kVisibilitySamplesAcross *
                                                     static_cast<int>(kVisibilitySamplesAcross * at.y) +
                                                 static_cast<int>(kVisibilitySamplesAcross * at.x));
    }
    return out;
}();

}  // namespace

Vec2f PixelSamples::middle(SampleMask samples) const {
    if (samples == all()) return {0.5f, 0.5f};
    if (quarters_ == 1) return place(kNearestOfSixteen[samples]);
    const Vec2f middle = mean_of(samples, across());
    // Usually the sample nearest to the middle is one of them.
    const int column = static_cast<int>(8 * middle.x), row = static_cast<int>(8 * middle.y);
    const int about = kVisibilitySamples * (2 * (row / 4) + column / 4) + 4 * (row % 4) + column % 4;
    return samples >> about & 1u ? place(about) : nearest_to(*this, samples, middle);
}

SubpixelMoments PixelSamples::moments(SampleMask samples) const {
    // The crossed difference counts the upper left and the lower right.
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

namespace {

using PlaceOrder = std::array<std::uint8_t, kVisibilitySamples>;  // Places of a 4 x 4 grid, by rows.

// in_turns: takes the samples around each place in turn; otherwise all would be on the same side of their
// places.
int next_in(const PlaceOrder& order, bool in_turns, const PixelSamples& grid, SampleMask& rest,
            SampleMask all) {
    if (rest == 0) rest = all;
    for (std::size_t i = 0; i < order.size(); ++i)
        if (SampleMask here = rest & grid.about(order[i])) {
            rest &= ~here;
            for (int left = in_turns ? static_cast<int>(i) % std::popcount(here) : 0; left > 0; --left)
                here &= here - 1;
            return std::countr_zero(here);
        }
    return 0;
}

}  // namespace

int next_sample(const PixelSamples& grid, SampleMask& rest, SampleMask all) {
    // The first four are the corners of a square.
    constexpr PlaceOrder kOrder{0, 10, 2, 8, 5, 15, 7, 13, 1, 11, 3, 9, 4, 14, 6, 12};
    return next_in(kOrder, false, grid, rest, all);
}

int next_sample_across(const PixelSamples& grid, SampleMask& rest, SampleMask all) {
    constexpr PlaceOrder kOrder{4, 11, 2, 13, 7, 8, 1, 14, 0, 15, 6, 9, 3, 12, 5, 10};
    return next_in(kOrder, true, grid, rest, all);
}

}  // namespace hilcam
