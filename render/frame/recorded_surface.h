#pragma once
// The surface that an entry of a pixel's record names (render/shading/pixel_record.h), as the frame that was placed last shows it.

#include <cstddef>
#include <cstdint>
#include <optional>

#include "render/shading/pixel_record.h"

namespace hilcam {

class FrameSetup;

struct RecordedSurface {
    std::size_t level = 0;      // level of detail, from 0, the mesh itself
    double level_error_m = 0;   // by which the level may be off
    std::size_t triangles = 0;  // number of the level's triangles
    // The probe whose light is looked up, the nearest of those about the point; none where no light is cached there.
    std::optional<std::uint32_t> probe;
    double probes_apart_m = 0;
    double distance_m = 0;  // from the camera
};

// Not for the loop.
RecordedSurface recorded_surface(const FrameSetup& setup, const PixelRecord::Entry& entry);

}  // namespace hilcam
