#pragma once
// The part of measure_clone() that makes maps: each pixel's offset, dark current and gain, their spreads, and
// the list of defects.

#include <span>

#include "emulator/clone/clone_measurement.h"
#include "emulator/clone/series_stack.h"

namespace hilcam {

struct MapWork {
    const FrameSet& frames;
    const CameraModel& like;
    std::span<const SeriesStack> stacks;
    std::vector<std::size_t> darks;  // at the reference temperature, shortest exposure first
    const PixelFaults& faults;
    const ResponseCurve* response;  // null: taken as straight
};
// Fills dsnu_e, prnu_fraction, dark_spread_e_s, the maps, the defects and what belongs to them. The
// measurement has its gain, light and darks already.
void measure_pixel_maps(const MapWork& work, CloneMeasurement& out);

}  // namespace hilcam
