#include "sensor/noise.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

// The row loops are compiled for three instruction sets and chosen at load time; with contraction off (see
// the build) every version gives the same bits. Sanitizers cannot follow the choice, so they get one version.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HILCAM_CLONES
#else
#define HILCAM_CLONES __attribute__((target_clones("arch=skylake-avx512", "avx2", "default")))
#endif

namespace hilcam {
namespace {

constexpr float kInversionBelow_e = 32;
constexpr std::size_t kBlock = 256;

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

// Philox words 0 and 1 for consecutive pixels (render/random.h, laid out for vector code).
HILCAM_CLONES void fill_uniforms(RandomKey key, std::uint32_t first_pixel, std::size_t count, float* shot,
                                 float* read) {
    for (std::size_t i = 0; i < count; ++i) {
        const auto words =
            random_words(key, RandomPurpose::kSensorNoise, first_pixel + static_cast<std::uint32_t>(i));
        shot[i] = uniform01(words[0]);
        read[i] = uniform01(words[1]);
    }
}

// Poisson by the corrected normal for every pixel, whatever its mean; the few or many small means are redone
// after.
HILCAM_CLONES void shoot_large(const float* mean_e, const float* shot, std::size_t count, float* electrons) {
    for (std::size_t i = 0; i < count; ++i) {
        const float mean = mean_e[i] > 0 ? mean_e[i] : 0.0f;
        const float z = quantile(shot[i]);
        electrons[i] =
            std::max(0.0f, std::floor(mean + std::sqrt(mean) * z + (z * z - 1.0f) * (1.0f / 6) + 0.5f));
    }
}

HILCAM_CLONES void convert(const float* electrons, const float* read, const DigitiserParameters& parameters,
                           std::size_t count, std::uint16_t* dn) {
    // Copied so that the compiler knows that the stores below do not change them.
    const DigitiserParameters p = parameters;
    for (std::size_t i = 0; i < count; ++i) {
        const float charge = std::min(electrons[i], p.full_well_e) + p.read_noise_e * quantile(read[i]);
        const float value = charge * p.gain_dn_e + p.offset_dn;
        dn[i] = static_cast<std::uint16_t>(
            static_cast<std::int32_t>(std::min(std::max(value, 0.0f), p.most_dn) + 0.5f));
    }
}

}  // namespace

float normal_quantile(float u) { return quantile(u); }

float poisson_inversion(float mean, float u) {
    if (!(mean > 0)) return 0;
    // exp(-mean) >= 1 - mean: most dark pixels end here.
    if (u < 1 - mean) return 0;
    double probability = std::exp(-static_cast<double>(mean));
    double cumulative = probability;
    int k = 0;
    while (static_cast<double>(u) > cumulative && k < 200) {
        ++k;
        probability *= static_cast<double>(mean) / k;
        cumulative += probability;
    }
    return static_cast<float>(k);
}

void digitise_row(std::span<const float> mean_e, const DigitiserParameters& parameters, RandomKey key,
                  std::uint32_t first_pixel, std::span<std::uint16_t> dn) {
    alignas(64) std::array<float, kBlock> shot, read, electrons;
    for (std::size_t start = 0; start < mean_e.size(); start += kBlock) {
        const std::size_t count = std::min(kBlock, mean_e.size() - start);
        const float* mean = mean_e.data() + start;
        fill_uniforms(key, first_pixel + static_cast<std::uint32_t>(start), count, shot.data(), read.data());
        shoot_large(mean, shot.data(), count, electrons.data());
        for (std::size_t i = 0; i < count; ++i)
            if (!(mean[i] >= kInversionBelow_e)) electrons[i] = poisson_inversion(mean[i], shot[i]);
        convert(electrons.data(), read.data(), parameters, count, dn.data() + start);
    }
}

}  // namespace hilcam
