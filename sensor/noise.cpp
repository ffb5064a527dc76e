#include "sensor/noise.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "render/vocabulary/clones.h"

namespace hilcam {
namespace {

constexpr float kInversionBelow_e = 32;
constexpr std::size_t kBlock = 128;
constexpr std::size_t kLanes = 32;  // pixels inverted side by side
// P(Poisson(32) > 92) is 1e-17, which no uniform number below 1 reaches.
constexpr int kMaxInverted_e = 92;

// Natural logarithm of a normal positive float: mantissa in [sqrt(1/2), sqrt(2)), then the series of
// log((1+s)/(1-s)) to s^9; error below 2e-7. Written without branches so that loops over it become vector
// code.
[[gnu::always_inline]] inline float fast_log(float x) {
    const auto bits = std::bit_cast<std::int32_t>(x);
    const std::int32_t exponent = (bits - 0x3F3504F3) >> 23;
    const float m = std::bit_cast<float>(bits - exponent * 0x800000);
    const float s = (m - 1.0f) / (m + 1.0f);
    const float s2 = s * s;
    const float series =
        2.0f * s * (1.0f + s2 * (1.0f / 3 + s2 * (1.0f / 5 + s2 * (1.0f / 7 + s2 * (1.0f / 9)))));
    return static_cast<float>(exponent) * 0.69314718f + series;
}

// exp(-x) for x in [0, 80]: 2^n (1 + p(r)), |r| <= ln 2 / 2, Taylor series to r^7; error below 3e-7 of the
// value.
[[gnu::always_inline]] inline float fast_exp_minus(float x) {
    const float n = std::floor(-x * 1.44269504f + 0.5f);
    // ln 2 is split into two parts, so that the product of n with the first is exact.
    const float r = (-x - n * 0.693359375f) + n * 2.12194440e-4f;
    const float series =
        1.0f +
        r * (1.0f +
             r * (1.0f / 2 + r * (1.0f / 6 + r * (1.0f / 24 +
                                                  r * (1.0f / 120 + r * (1.0f / 720 + r * (1.0f / 5040)))))));
    return series * std::bit_cast<float>((static_cast<std::int32_t>(n) + 127) << 23);
}

[[gnu::always_inline]] inline float quantile(float u) {
    const float x = 2.0f * u - 1.0f;
    const float w = -fast_log(4.0f * u * (1.0f - u));
    const float a = w - 2.5f;
    float middle = 2.81022636e-08f;
    middle = 3.43273939e-07f + middle * a;
    middle = -3.5233877e-06f + middle * a;
    middle = -4.39150654e-06f + middle * a;
    middle = 0.00021858087f + middle * a;
    middle = -0.00125372503f + middle * a;
    middle = -0.00417768164f + middle * a;
    middle = 0.246640727f + middle * a;
    middle = 1.50140941f + middle * a;
    const float b = std::sqrt(std::max(w, 0.0f)) - 3.0f;
    float tail = -0.000200214257f;
    tail = 0.000100950558f + tail * b;
    tail = 0.00134934322f + tail * b;
    tail = -0.00367342844f + tail * b;
    tail = 0.00573950773f + tail * b;
    tail = -0.0076224613f + tail * b;
    tail = 0.00943887047f + tail * b;
    tail = 1.00167406f + tail * b;
    tail = 2.83297682f + tail * b;
    return 1.41421356f * (w < 5.0f ? middle : tail) * x;
}

// Philox words of consecutive pairs of pixels (render/vocabulary/random.h, laid out for vector code): a
// pair's first pixel has words 0 and 1, its second 2 and 3.
HILCAM_CLONES void fill_uniforms(RandomKey key, std::uint32_t first_pair, float* shot, float* read) {
    for (std::size_t i = 0; i < kBlock / 2; ++i) {
        const auto words =
            random_words(key, RandomPurpose::kSensorNoise, first_pair + static_cast<std::uint32_t>(i));
        shot[2 * i] = uniform01(words[0]);
        read[2 * i] = uniform01(words[1]);
        shot[2 * i + 1] = uniform01(words[2]);
        read[2 * i + 1] = uniform01(words[3]);
    }
}

// Draws Poisson numbers by the corrected normal for every pixel, whatever its mean; small means are drawn
// again afterwards.
HILCAM_CLONES void shoot_large(const float* mean_e, const float* shot, float* electrons) {
    for (std::size_t i = 0; i < kBlock; ++i) {
        const float mean = mean_e[i] > 0 ? mean_e[i] : 0.0f;
        const float z = quantile(shot[i]);
        electrons[i] =
            std::max(0.0f, std::floor(mean + std::sqrt(mean) * z + (z * z - 1.0f) * (1.0f / 6) + 0.5f));
    }
}

HILCAM_CLONES std::int32_t count_large(const float* mean_e) {
    std::int32_t large = 0;
    for (std::size_t i = 0; i < kBlock; ++i) large += mean_e[i] >= kInversionBelow_e ? 1 : 0;
    return large;
}

// Draws exact Poisson numbers by inversion for the means below kInversionBelow_e among kLanes pixels. All
// walk through the distribution together until the last has found its count.
HILCAM_CLONES void shoot_small(const float* mean_e, const float* shot, float* electrons) {
    // Written as vectors of eight, four at a time, because compilers do not vectorise a loop with an early
    // end.
    using Lanes [[gnu::vector_size(8 * sizeof(float))]] = float;
    using Words [[gnu::vector_size(8 * sizeof(float))]] = std::int32_t;
    constexpr std::size_t kVectors = kLanes / 8;
    alignas(64) std::array<float, kLanes> small, chance;
    for (std::size_t i = 0; i < kLanes; ++i) {
        small[i] = mean_e[i] > 0 && mean_e[i] < kInversionBelow_e ? mean_e[i] : 0.0f;
        chance[i] = fast_exp_minus(small[i]);
    }
    Lanes mean[kVectors], probability[kVectors], uniform[kVectors], cumulative[kVectors], found[kVectors];
    std::memcpy(mean, small.data(), sizeof mean);
    std::memcpy(probability, chance.data(), sizeof probability);
    std::memcpy(cumulative, chance.data(), sizeof cumulative);
    std::memcpy(uniform, shot, sizeof uniform);
    for (Lanes& f : found) f = Lanes{};
    for (int k = 1; k <= kMaxInverted_e; ++k) {
        const float inverse = 1.0f / static_cast<float>(k);
        Words walking = {};
        for (std::size_t v = 0; v < kVectors; ++v) {
            const Words on = uniform[v] > cumulative[v];
            walking |= on;
            found[v] += on ? Lanes{} + 1.0f : Lanes{};
            probability[v] *= mean[v] * inverse;
            cumulative[v] += probability[v];
        }
        std::array<std::uint64_t, 4> pairs;
        std::memcpy(pairs.data(), &walking, sizeof pairs);
        if ((pairs[0] | pairs[1] | pairs[2] | pairs[3]) == 0) break;
    }
    std::memcpy(small.data(), found, sizeof found);
    for (std::size_t i = 0; i < kLanes; ++i)
        electrons[i] = mean_e[i] >= kInversionBelow_e ? electrons[i] : small[i];
}

HILCAM_CLONES void quantiles(const float* uniform, std::size_t count, float* deviates) {
    for (std::size_t i = 0; i < count; ++i) deviates[i] = quantile(uniform[i]);
}

}  // namespace

float normal_quantile(float u) { return quantile(u); }

void draw_pixels(std::span<const float> mean_e, RandomKey key, std::uint32_t first_pixel,
                 std::span<float> charge_e, std::span<float> deviates) {
    alignas(64) std::array<float, kBlock> mean, shot, read, electrons{};
    // Blocks begin at the first pixel of a pair; if a row begins with a second pixel, one place stays empty.
    std::size_t lead = first_pixel % 2;
    std::size_t done = 0;
    const std::size_t size = std::max(mean_e.size(), deviates.size());
    while (done < size) {
        const std::size_t count = std::min(kBlock - lead, size - done);
        fill_uniforms(key, (first_pixel + static_cast<std::uint32_t>(done)) / 2, shot.data(), read.data());
        if (!charge_e.empty()) {
            mean.fill(0.0f);
            std::copy_n(mean_e.data() + done, count, mean.data() + lead);
            // Most blocks of a picture of space are completely dark, and many others completely bright.
            const std::int32_t large = count_large(mean.data());
            if (large > 0) shoot_large(mean.data(), shot.data(), electrons.data());
            if (large < static_cast<std::int32_t>(kBlock))
                for (std::size_t i = 0; i < kBlock; i += kLanes)
                    shoot_small(mean.data() + i, shot.data() + i, electrons.data() + i);
            std::copy_n(electrons.data() + lead, count, charge_e.data() + done);
        }
        if (!deviates.empty()) quantiles(read.data() + lead, count, deviates.data() + done);
        done += count;
        lead = 0;
    }
}

namespace {

// Fills four numbers for each call; block: number of the first call.
HILCAM_CLONES void fill_uniforms(RandomKey key, RandomPurpose purpose, std::uint32_t index,
                                 std::uint32_t block, float* uniform) {
    for (std::size_t i = 0; i < kBlock / 4; ++i) {
        const auto words = random_words(key, purpose, block + static_cast<std::uint32_t>(i), index);
        for (std::size_t k = 0; k < 4; ++k) uniform[4 * i + k] = uniform01(words[k]);
    }
}

}  // namespace

void draw_normals(RandomKey key, RandomPurpose purpose, std::uint32_t index, std::uint64_t first,
                  std::span<float> deviates) {
    alignas(64) std::array<float, kBlock> uniform;
    std::size_t lead = first % 4;
    std::size_t done = 0;
    while (done < deviates.size()) {
        const std::size_t count = std::min(kBlock - lead, deviates.size() - done);
        fill_uniforms(key, purpose, index, static_cast<std::uint32_t>((first + done) / 4), uniform.data());
        quantiles(uniform.data() + lead, count, deviates.data() + done);
        done += count;
        lead = 0;
    }
}

std::uint32_t poisson_count(double mean, double uniform) {
    if (!(mean > 0)) return 0;
    if (mean > 500) {
        const double z = static_cast<double>(normal_quantile(static_cast<float>(uniform)));
        return static_cast<std::uint32_t>(
            std::max(0.0, std::floor(mean + std::sqrt(mean) * z + (z * z - 1) / 6 + 0.5)));
    }
    double probability = std::exp(-mean), cumulative = probability;
    std::uint32_t count = 0;
    // Uniform numbers end at 1 - 2^-24, so no count comes near the limit.
    while (uniform > cumulative && count < 2000) {
        probability *= mean / ++count;
        cumulative += probability;
    }
    return count;
}

}  // namespace hilcam
