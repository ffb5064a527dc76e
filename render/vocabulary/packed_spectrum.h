#pragma once
// A spectrum in little more than half the memory: sixteen bits a bin, as shares of the largest. Not for
// negative values. Largest error: 8e-6 of the largest bin.

#include <array>
#include <cstdint>

#include "render/vocabulary/spectrum.h"

namespace hilcam {

class PackedSpectrum {
  public:
    PackedSpectrum() = default;
    explicit PackedSpectrum(const Spectrum& s) : scale_(largest(s) * (1 / kMax)) {
        const float inverse = scale_ > 0 ? 1 / scale_ : 0.0f;
        for (std::size_t i = 0; i < share_.size(); ++i)
            share_[i] = static_cast<std::uint16_t>(s.bin[i] * inverse + 0.5f);
    }
    Spectrum unpacked() const {
        Spectrum s;
        for (std::size_t i = 0; i < share_.size(); ++i) s.bin[i] = scale_ * static_cast<float>(share_[i]);
        return s;
    }

  private:
    static constexpr float kMax = 65535;

    std::array<std::uint16_t, kMaxBins> share_{};
    float scale_ = 0;
};
static_assert(sizeof(PackedSpectrum) == 20);

}  // namespace hilcam
