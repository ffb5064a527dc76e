#include "render/vocabulary/packed_spectrum.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace hilcam {
namespace {

constexpr std::size_t kCount = 23;

// The i-th of some spectra whose bins are worth 1 to 1e-5 of the greatest, which differ by 1e6 among them.
Spectrum spectrum(std::size_t i) {
    Spectrum s;
    for (int b = 0; b < kMaxBins; ++b)
        s[b] = std::pow(10.0f, static_cast<float>(i % 7) - 3) *
               std::pow(10.0f, -static_cast<float>((static_cast<int>(i) + 3 * b) % 6));
    return s;
}

TEST(PackedSpectrum, IsOffByAShareOfTheLargestBin) {
    for (std::size_t i = 0; i < kCount; ++i) {
        const Spectrum s = spectrum(i), back = PackedSpectrum(s).unpacked();
        for (int b = 0; b < kMaxBins; ++b)
            EXPECT_NEAR(back[b], s[b], 8e-6f * max_component(s)) << i << " " << b;
    }
    for (const float bin : PackedSpectrum(Spectrum{}).unpacked().bin) EXPECT_EQ(bin, 0);
}

// Bit by bit: frames do not depend on which vectors a machine has.
TEST(PackedSpectrum, SumsAreThoseOfOneAfterTheOther) {
    std::array<PackedSpectrum, kCount> packed;
    std::array<float, kCount> weight;
    std::array<std::uint32_t, kCount> index;
    for (std::size_t i = 0; i < kCount; ++i) {
        packed[i] = PackedSpectrum(spectrum(i));
        weight[i] = 1 / (1 + static_cast<float>(i));
        index[i] = static_cast<std::uint32_t>(5 * i % (kCount / 2));
    }
    Spectrum all, some;
    for (std::size_t i = 0; i < kCount; ++i) {
        all += weight[i] * packed[i].unpacked();
        some += weight[i] * packed[2 * index[i] + 1].unpacked();
    }
    EXPECT_EQ(PackedSpectrum::weighted_sum(packed.data(), weight.data(), kCount).bin, all.bin);
    EXPECT_EQ(PackedSpectrum::weighted_sum(packed.data() + 1, 2, index.data(), weight.data(), kCount).bin,
              some.bin);
    EXPECT_EQ(PackedSpectrum::weighted_sum(packed.data(), weight.data(), 0).bin, Spectrum{}.bin);
}

}  // namespace
}  // namespace hilcam
