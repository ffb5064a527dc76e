#pragma once
// Describes the surface of an entry in a pixel's record (render/shading/pixel_record.h), as the last placed
// frame shows it.

#include <cstddef>
#include <cstdint>
#include <optional>

#include "render/shading/pixel_record.h"

namespace hilcam {

class FrameSetup;

struct RecordedSurface {
    std::size_t level = 0;      // level of detail; 0 is the full mesh
    double level_error_m = 0;   // largest error of the level
    std::size_t triangles = 0;  // number of the level's triangles
    // The nearest probe about the point, from which cached light is looked up; none if no light is cached
    // there.
    std::optional<std::uint32_t> probe;
    double probes_apart_m = 0;
    double distance_m = 0;  // from the camera
};

// Not for the loop.
RecordedSurface recorded_surface(const FrameSetup& setup, const PixelRecord::Entry& entry);

}  // namespace hilcam
