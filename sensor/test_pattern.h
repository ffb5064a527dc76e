#pragma once
// Pictures that a camera makes by itself, in place of what it sees: to check a link, not a scene.

#include <cstdint>

#include "render/vocabulary/image.h"

namespace hilcam {

enum class TestPattern : std::uint8_t {
    kOff,
    kBlack,
    kWhite,
    kRampHorizontal,  // DN = column, from 0 on again after full scale
    kRampVertical,
    kRampHorizontalMoving,  // one column further with every frame
};

// Overwrites a frame of `bits` bits, but for kOff. Loop.
void draw_test_pattern(TestPattern pattern, int bits, std::uint64_t frame, DnImage& image);

}  // namespace hilcam
