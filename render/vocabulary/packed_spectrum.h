#pragma once
// A spectrum in little more than half the memory: 16 bits a bin, relative to the largest bin. Largest error:
// 8e-6 of the largest bin. Not for negative values.

#include <array>
#include <cstddef>
#include <cstdint>

#include "render/vocabulary/spectrum.h"

namespace hilcam {

class PackedSpectrum {
  public:
    PackedSpectrum() = default;
    explicit PackedSpectrum(const Spectrum& s) : scale_(max_component(s) * (1 / kMax)) {
        const float inverse = scale_ > 0 ? 1 / scale_ : 0.0f;
        for (std::size_t i = 0; i < share_.size(); ++i)
            share_[i] = static_cast<std::uint16_t>(s.bin[i] * inverse + 0.5f);
    }
    // Returns the largest bin.
    float greatest() const { return kMax * scale_; }
    Spectrum unpacked() const {
        Spectrum s;
        for (std::size_t i = 0; i < share_.size(); ++i) s.bin[i] = scale_ * static_cast<float>(share_[i]);
        return s;
    }

    // Returns the weighted sum of `count` spectra, computed in vectors. The first form takes the spectra at
    // first[index[i] * stride], the second takes consecutive ones.
    static Spectrum weighted_sum(const PackedSpectrum* first, std::size_t stride, const std::uint32_t* index,
                                 const float* weight, std::size_t count);
    static Spectrum weighted_sum(const PackedSpectrum* first, const float* weight, std::size_t count);

  private:
    static constexpr float kMax = 65535;

    friend struct PackedSums;
    std::array<std::uint16_t, kMaxBins> share_{};
    float scale_ = 0;
};
static_assert(sizeof(PackedSpectrum) == 20);

}  // namespace hilcam
