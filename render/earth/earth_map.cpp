#include "render/earth/earth_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "render/earth/map_looks.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/clones.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr int kChannels = EarthSample::kChannels;
// The code x = c / 255 means the value x (square x + plain).
struct Coding {
    alignas(32) std::array<float, kChannels> square{1, 1, 1, 1, 0, 0, 0, 1}, plain{0, 0, 0, 0, 1, 1, 1, 0};
};
constexpr Coding kCoding;

void add_texel(const EarthMap::Texel& texel, float weight, EarthSample& sum) {
    for (std::size_t c = 0; c < kChannels; ++c) {
        const float x = (1.0f / 255) * static_cast<float>(texel[c]);
        sum.value[c] += weight * (x * (x * kCoding.square[c] + kCoding.plain[c]));
    }
}

// Vectors are written out because GCC 12 processes a plain loop over the channels in pairs, and converts
// bytes to 32 bits one by one.
HILCAM_CLONES void mix_four(const EarthMap::Texel& a, const EarthMap::Texel& b, const EarthMap::Texel& c,
                            const EarthMap::Texel& d, const std::array<float, 4>& weight, EarthSample& sum) {
    using Codes [[gnu::vector_size(kChannels)]] = std::uint8_t;
    using Halves [[gnu::vector_size(kChannels * sizeof(std::uint16_t))]] = std::uint16_t;
    using Wholes [[gnu::vector_size(kChannels * sizeof(std::int32_t))]] = std::int32_t;
    using Values [[gnu::vector_size(kChannels * sizeof(float))]] = float;
    Values square, plain, all;
    std::memcpy(&square, kCoding.square.data(), sizeof square);
    std::memcpy(&plain, kCoding.plain.data(), sizeof plain);
    std::memcpy(&all, sum.value.data(), sizeof all);
    const auto value = [&](const EarthMap::Texel& texel) {
        Codes codes;
        std::memcpy(&codes, texel.data(), sizeof codes);
        const Wholes wholes = __builtin_convertvector(__builtin_convertvector(codes, Halves), Wholes);
        const Values x = (1.0f / 255) * __builtin_convertvector(wholes, Values);
        return x * (x * square + plain);
    };
    all += weight[0] * value(a) + weight[1] * value(b) + weight[2] * value(c) + weight[3] * value(d);
    std::memcpy(sum.value.data(), &all, sizeof all);
}

void add_bilinear(const EarthMap::Level& level, float u, float v, float weight, EarthSample& sum) {
    const float x = (u - std::floor(u)) * static_cast<float>(level.width) - 0.5f;
    const float y = std::clamp(v, 0.0f, 1.0f) * static_cast<float>(level.height) - 0.5f;
    const float left = std::floor(x), top = std::floor(y);
    const float fx = x - left, fy = y - top;
    const auto column = [&](int i) {
        return i < 0 ? i + level.width : (i >= level.width ? i - level.width : i);
    };
    const int x0 = column(static_cast<int>(left)), x1 = column(static_cast<int>(left) + 1);
    const int y0 = std::clamp(static_cast<int>(top), 0, level.height - 1);
    const int y1 = std::clamp(static_cast<int>(top) + 1, 0, level.height - 1);
    const auto row = [&](int j) {
        return level.texels.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(level.width);
    };
    EarthMap::mix_texels({row(y0) + x0, row(y0) + x1, row(y1) + x0, row(y1) + x1}, fx, fy, weight, sum);
}

}  // namespace

EarthMap::Texel EarthMap::coded(const EarthSample& sample) {
    Texel out;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const float x = kCoding.square[c] > 0 ? std::sqrt(sample.value[c]) : sample.value[c];
        out[c] = static_cast<std::uint8_t>(std::clamp(255 * x + 0.5f, 0.0f, 255.0f));
    }
    return out;
}

void EarthMap::mix_texels(const std::array<const Texel*, 4>& corner, float right, float down, float weight,
                          EarthSample& sum) {
    const float above = weight * (1 - down), below = weight * down;
    mix_four(*corner[0], *corner[1], *corner[2], *corner[3],
             {(1 - right) * above, right * above, (1 - right) * below, right * below}, sum);
}

EarthMap::EarthMap(std::vector<Level> levels) : levels_(std::move(levels)) {
    HILCAM_CHECK(!levels_.empty() && levels_.back().height == 1);
    for (std::size_t i = 0; i < levels_.size(); ++i) {
        const Level& level = levels_[i];
        HILCAM_CHECK(level.width == 2 * level.height && level.height <= kMaxHeight);
        HILCAM_CHECK(level.texels.size() ==
                     static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height));
        HILCAM_CHECK(i == 0 || 2 * level.height == levels_[i - 1].height);
    }
}

std::vector<EarthMap::Level> EarthMap::halves(Level finest) {
    std::vector<Level> out{std::move(finest)};
    while (out.back().height > 1) {
        const Level& fine = out.back();
        Level half{fine.width / 2, fine.height / 2, {}};
        half.texels.reserve(fine.texels.size() / 4);
        for (int y = 0; y < half.height; ++y)
            for (int x = 0; x < half.width; ++x) {
                EarthSample sum;
                for (const int row : {2 * y, 2 * y + 1})
                    for (const int column : {2 * x, 2 * x + 1})
                        add_texel(
                            fine.texels[static_cast<std::size_t>(row) * static_cast<std::size_t>(fine.width) +
                                        static_cast<std::size_t>(column)],
                            0.25f, sum);
                half.texels.push_back(coded(sum));
            }
        out.push_back(std::move(half));
    }
    return out;
}

std::size_t EarthMap::bytes() const {
    std::size_t sum = 0;
    for (const Level& level : levels_) sum += level.texels.size() * sizeof(Texel);
    return sum;
}

void EarthMap::add_at_level(float u, float v, float level, float weight, EarthSample& sum) const {
    const float at = std::clamp(level, 0.0f, static_cast<float>(levels_.size() - 1));
    const auto low = static_cast<std::size_t>(at);
    const float share = at - static_cast<float>(low);
    if (share < 1e-3f || low + 1 == levels_.size()) return add_bilinear(levels_[low], u, v, weight, sum);
    add_bilinear(levels_[low], u, v, weight * (1 - share), sum);
    add_bilinear(levels_[low + 1], u, v, weight * share, sum);
}

EarthSample EarthMap::sample(float u, float v, const MapFootprint& f) const {
    EarthSample sum;
    each_look(u, v, f, {static_cast<float>(width()), static_cast<float>(height())},
              [&](float at_u, float at_v, float level, float weight) {
                  add_at_level(at_u, at_v, level, weight, sum);
              });
    return sum;
}

EarthSample EarthMap::sample(float u, float v, float width) const {
    EarthSample sum;
    add_at_level(u, v, std::log2(std::max(1.0f, width * static_cast<float>(height()))), 1, sum);
    return sum;
}

EarthSample EarthMap::mean() const {
    // A level of about a degree suffices, weighted by the areas of its rows.
    const auto fine =
        std::find_if(levels_.begin(), levels_.end(), [](const Level& l) { return l.height <= 256; });
    EarthSample sum;
    double weights = 0;
    for (int y = 0; y < fine->height; ++y) weights += std::sin(kPi * (y + 0.5) / fine->height);
    for (int y = 0; y < fine->height; ++y) {
        const double weight = std::sin(kPi * (y + 0.5) / fine->height) / (weights * fine->width);
        for (int x = 0; x < fine->width; ++x)
            add_texel(fine->texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(fine->width) +
                                   static_cast<std::size_t>(x)],
                      static_cast<float>(weight), sum);
    }
    return sum;
}

}  // namespace hilcam
