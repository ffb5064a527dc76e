#pragma once
// Detects light that is not finite. A NaN or infinity, for example from a division by zero in a path model or
// plug-in, would darken or flood the whole picture once the optics' halo has spread it.

#include <cstdint>
#include <span>

#include "render/vocabulary/spectrum.h"

namespace hilcam {

inline bool is_finite(const Spectrum& light) {
    // 0 times a finite number is 0; 0 times an infinity or NaN is NaN.
    float sum = 0;
    for (int b = 0; b < kMaxBins; ++b) sum += 0 * light[b];
    return sum == 0;
}

// Sets pixels whose light is not finite to zero, and returns their number. Loop, any thread.
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
