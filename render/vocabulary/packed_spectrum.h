#pragma once
// A spectrum in little more than half the memory: sixteen bits a bin, as shares of the largest. Not for
// negative values. Largest error: 8e-6 of the largest bin.

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
    // Returns the greatest of its bins.
    float greatest() const { return kMax * scale_; }
    Spectrum unpacked() const {
        Spectrum s;
        for (std::size_t i = 0; i < share_.size(); ++i) s.bin[i] = scale_ * static_cast<float>(share_[i]);
        return s;
    }

    // Returns the sum of each one's weight times it, in vectors: of those at first[index[i] * stride], or of those one
    // behind the other. Weights and spectra: count of them.
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
