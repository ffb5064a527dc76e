#include "render/vocabulary/packed_spectrum.h"

#include <cstring>

#include "render/vocabulary/clones.h"

namespace hilcam {

// The loops of the sums, compiled for several vector widths; all of them add in the same order.
struct PackedSums {
    using Bins [[gnu::vector_size(kMaxBins * sizeof(float))]] = float;
    using Wholes [[gnu::vector_size(kMaxBins * sizeof(std::int32_t))]] = std::int32_t;
    using Shares [[gnu::vector_size(kMaxBins * sizeof(std::uint16_t))]] = std::uint16_t;

    [[gnu::always_inline]] static void add(const PackedSpectrum& packed, float weight, Bins& sum) {
        Shares shares;
        std::memcpy(&shares, packed.share_.data(), sizeof shares);
        sum +=
            weight * (packed.scale_ * __builtin_convertvector(__builtin_convertvector(shares, Wholes), Bins));
    }

    HILCAM_CLONES static void of_some(const PackedSpectrum* first, std::size_t stride,
                                      const std::uint32_t* index, const float* weight, std::size_t count,
                                      float* out) {
        Bins sum = {};
        for (std::size_t i = 0; i < count; ++i) add(first[index[i] * stride], weight[i], sum);
        std::memcpy(out, &sum, sizeof sum);
    }
    HILCAM_CLONES static void of_all(const PackedSpectrum* first, const float* weight, std::size_t count,
                                     float* out) {
        Bins sum = {};
        for (std::size_t i = 0; i < count; ++i) add(first[i], weight[i], sum);
        std::memcpy(out, &sum, sizeof sum);
    }
};

Spectrum PackedSpectrum::weighted_sum(const PackedSpectrum* first, std::size_t stride,
                                      const std::uint32_t* index, const float* weight, std::size_t count) {
    Spectrum sum;
    PackedSums::of_some(first, stride, index, weight, count, sum.bin.data());
    return sum;
}

Spectrum PackedSpectrum::weighted_sum(const PackedSpectrum* first, const float* weight, std::size_t count) {
    Spectrum sum;
    PackedSums::of_all(first, weight, count, sum.bin.data());
    return sum;
}

}  // namespace hilcam
