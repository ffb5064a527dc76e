#pragma once
// Faults of the picture itself (fault.h): stuck, black, saturated, torn, flipped bits. They strike the
// finished frame, so every output shows the same.

#include <cstdint>
#include <optional>

#include "io/contract/fault.h"
#include "render/vocabulary/image.h"
#include "render/vocabulary/random.h"

namespace hilcam {

struct FrameRecord;

// Those that strike one frame.
struct ImageFaults {
    bool stuck = false, black = false, saturated = false;
    std::optional<double> tear_share{};  // share of the height from which on rows are of the frame before
    std::optional<double> flip_rate{};   // per pixel

    friend bool operator==(const ImageFaults&, const ImageFaults&) = default;
};

// Returns what the board has for a frame. Strikes are counted, but for flipped bits. Loop.
ImageFaults image_faults(FaultBoard& faults, std::uint64_t frame);

// Strikes `frame`. `before` is what was published before it, and may have another size: then the faults that
// need it leave the frame as it is. Gives how many pixels had a bit flipped: a pure function of its
// arguments, as is the picture. Loop: no allocation.
std::uint64_t strike_image(const ImageFaults& faults, const FrameRecord& record, std::uint64_t seed,
                           const DnImage& before, DnImage& frame);

// Bits of all faults that strike a frame as a whole, the picture's among them; those of single packets, of
// the control channel and of devices are not in it. Counts nothing. Loop.
std::uint64_t frame_faults(const FaultBoard& faults, std::uint64_t frame);

}  // namespace hilcam
