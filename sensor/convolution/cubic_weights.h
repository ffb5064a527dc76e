#pragma once
// Keys' cubic convolution (IEEE Trans. ASSP 29(6), 1981), a = -1/2.

#include <array>

namespace hilcam {

// Returns the weights of samples at -1, 0, 1 and 2 for interpolation at u in [0, 1).
inline std::array<double, 4> cubic_weights(double u) {
    return {((-0.5 * u + 1.0) * u - 0.5) * u, (1.5 * u - 2.5) * u * u + 1.0, ((-1.5 * u + 2.0) * u + 0.5) * u,
            (0.5 * u - 0.5) * u * u};
}

}  // namespace hilcam
