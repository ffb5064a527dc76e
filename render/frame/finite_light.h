#pragma once
// Light that is a number. A radiance without one - a division by nothing in a path model, be it a plug-in's - would darken or
// flood a whole picture once the optics' halo has spread it.

#include <cstdint>
#include <span>

#include "render/vocabulary/spectrum.h"

namespace hilcam {

inline bool is_finite(const Spectrum& light) {
    // Nothing times a number is nothing; times what is none it is not.
    float sum = 0;
    for (int b = 0; b < kMaxBins; ++b) sum += 0 * light[b];
    return sum == 0;
}

// Makes pixels dark whose light is no number. Returns how many there were. Loop, any thread.
inline std::uint64_t leave_out_not_finite(std::span<Spectrum> pixels) {
    Spectrum probe;
    for (const Spectrum& pixel : pixels) probe += 0 * pixel;
    if (is_finite(probe)) return 0;
    std::uint64_t count = 0;
    for (Spectrum& pixel : pixels)
        if (!is_finite(pixel)) pixel = {}, ++count;
    return count;
}

}  // namespace hilcam
