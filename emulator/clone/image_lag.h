#pragma once
// Lag: what is left of a bright frame in the dark frames after it.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "sensor/measure/frame_statistics.h"

namespace hilcam {

// The part of a bright frame's signal that is left in the k-th dark frame after it, k = 1, 2, ...
struct ImageLag {
    std::vector<Measured> left;
    std::size_t passed_over = 0;  // frames that were lit in part while the light went off
};

// means: mean values of the frames, in the order of their taking [any unit that is linear in light], bright
// ones first; the light may go on and off several times. Throws InputError, one line, for frames without
// bright ones that at least twelve dark ones follow.
ImageLag image_lag(std::span<const double> means, const std::string& name);

}  // namespace hilcam
