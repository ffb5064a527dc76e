#pragma once
// A frame on its way through the loop: what one stage hands to the other. A slot's memory is allocated before
// the start and serves one frame after the other.

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
    // --- The render stage's, for the sense stage.
    FrameUse use;
    FrameRecord record;
    Exposure exposure;
    RadianceImage radiance;
    std::vector<PointSource> points;
    std::vector<SideLight> beside;             // light from beside the picture
    std::vector<std::uint64_t> shown_numbers;  // for a recorder: the newest command of each thing
    std::int64_t not_before_ns = 0;  // earliest time at which a script's frame may be published; 0: any
    std::int64_t middle_camera_ns = 0, end_camera_ns = 0;  // instants of the exposure, camera's time
    // Earliest instant of that time at which it may be published.
    std::int64_t leaves_camera_ns = std::numeric_limits<std::int64_t>::min();
    bool automatic = false;      // the camera sets the next exposure itself
    std::int64_t render_ns = 0;  // time that rendering took; 0: nothing was

    // --- The sense stage's, for the frame that takes the slot over.
    std::int64_t sense_ns = 0;   // time that it took, publishing in it
    double next_exposure_s = 0;  // exposure that automatic exposure asks for; 0: not measured
};

}  // namespace hilcam
