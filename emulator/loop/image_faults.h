#pragma once
// Faults of the picture itself (fault.h): stuck, black, saturated, torn, flipped bits. They are applied to
// the finished frame, so every output shows the same.

#include <cstdint>
#include <optional>

#include "io/contract/fault.h"
#include "render/vocabulary/image.h"
#include "render/vocabulary/random.h"

namespace hilcam {

struct FrameRecord;

// The faults of one frame.
struct ImageFaults {
    bool stuck = false, black = false, saturated = false;
    std::optional<double> tear_share{};  // share of the height below which rows come from the previous frame
    std::optional<double> flip_rate{};   // probability for each pixel

    friend bool operator==(const ImageFaults&, const ImageFaults&) = default;
};

// Returns the faults that the board has for a frame. Counts strikes, except for flipped bits. Loop.
ImageFaults image_faults(FaultBoard& faults, std::uint64_t frame);

// Applies the faults to `frame`. before: the previously published frame; if its size differs, faults that
// need it do nothing. Returns how many pixels had a bit flipped. The result is a pure function of the
// arguments. Loop: no allocation.
std::uint64_t strike_image(const ImageFaults& faults, const FrameRecord& record, std::uint64_t seed,
                           const DnImage& before, DnImage& frame);

// Returns the bits of all faults that strike a frame as a whole, including those of the picture. Faults of
// single packets, of the control channel and of devices are not included. Counts nothing. Loop.
std::uint64_t frame_faults(const FaultBoard& faults, std::uint64_t frame);

}  // namespace hilcam
