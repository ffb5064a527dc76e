#pragma once
// Pictures that a camera generates itself instead of what it sees: for checking a link, not a scene.

#include <cstdint>

#include "render/vocabulary/image.h"

namespace hilcam {

enum class TestPattern : std::uint8_t {
    kOff,
    kBlack,
    kWhite,
    kRampHorizontal,  // DN = column, starting at 0 again after full scale
    kRampVertical,
    kRampHorizontalMoving,  // moves by one column with every frame
};

// Overwrites a frame with `bits` bits, unless the pattern is kOff. Loop.
void draw_test_pattern(TestPattern pattern, int bits, std::uint64_t frame, DnImage& image);

}  // namespace hilcam
