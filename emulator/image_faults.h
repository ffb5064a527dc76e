#pragma once
// Faults of the picture itself (fault.h): stuck, black, saturated, torn, flipped bits. They strike the
// finished frame, so every output shows the same.

#include "io/fault.h"
#include "render/image.h"
#include "render/random.h"

namespace hilcam {

struct FrameRecord;

// Strikes `frame`. `before` is what was published before it, and may have another size: then the faults that
// need it leave the frame as it is. Loop: no allocation.
void strike_image(FaultBoard& faults, const FrameRecord& record, std::uint64_t seed, const DnImage& before,
                  DnImage& frame);

// Bits of all faults that strike a frame as a whole, the picture's among them; those of single packets, of
// the control channel and of devices are not in it. Counts nothing. Loop.
std::uint64_t frame_faults(const FaultBoard& faults, std::uint64_t frame);

}  // namespace hilcam
