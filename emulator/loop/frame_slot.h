#pragma once
// A frame on its way through the loop: the data that one stage hands to the other. A slot's memory is
// allocated before the start and is used for one frame after the other.

#include <cstdint>
#include <limits>
#include <vector>

#include "emulator/loop/frame_script.h"
#include "io/contract/frame_sink.h"
#include "render/vocabulary/point_source.h"
#include "render/vocabulary/radiance_image.h"
#include "render/vocabulary/side_light.h"
#include "sensor/chain.h"

namespace hilcam {

struct FrameSlot {
    // --- written by the render stage for the sense stage
    FrameUse use;
    FrameRecord record;
    Exposure exposure;
    RadianceImage radiance;
    std::vector<PointSource> points;
    std::vector<SideLight> beside;             // light from outside the picture
    std::vector<std::uint64_t> shown_numbers;  // newest command of each thing, for a recorder
    std::int64_t not_before_ns = 0;            // a script's earliest time of publication; 0: any time
    // Middle and end of the exposure in the camera's time.
    std::int64_t middle_camera_ns = 0, end_camera_ns = 0;
    // Earliest time of publication, in the camera's time.
    std::int64_t leaves_camera_ns = std::numeric_limits<std::int64_t>::min();
    bool automatic = false;      // true: the camera sets the next exposure itself
    std::int64_t render_ns = 0;  // time for rendering; 0: nothing was rendered

    // --- written by the sense stage for the frame that uses the slot next
    std::int64_t sense_ns = 0;   // time for sensing and publishing
    double next_exposure_s = 0;  // exposure that automatic exposure wants; 0: not measured
};

}  // namespace hilcam
