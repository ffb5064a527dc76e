#pragma once
// A spectrum in half the memory: the upper sixteen bits of each float (bfloat16), rounded to nearest. Values keep
// their range and eight bits: an error of 0.2 % at most.

#include <array>
#include <bit>
#include <cstdint>

#include "render/vocabulary/spectrum.h"

namespace hilcam {

class PackedSpectrum {
  public:
    PackedSpectrum() = default;
    explicit PackedSpectrum(const Spectrum& s) {
        for (std::size_t i = 0; i < half_.size(); ++i)
            half_[i] = static_cast<std::uint16_t>((std::bit_cast<std::uint32_t>(s.bin[i]) + 0x8000u) >> 16);
    }
    Spectrum unpacked() const {
        Spectrum s;
        for (std::size_t i = 0; i < half_.size(); ++i)
            s.bin[i] = std::bit_cast<float>(static_cast<std::uint32_t>(half_[i]) << 16);
        return s;
    }

  private:
    std::array<std::uint16_t, kMaxBins> half_{};
};
static_assert(sizeof(PackedSpectrum) == 16);

}  // namespace hilcam
