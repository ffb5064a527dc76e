#pragma once
// Measures how long a frame of the first instant takes on this machine, which `hilcam check` tells before a
// run. `hilcam bench` measures it around the target, paced, and with its spread.

#include <optional>
#include <string>

#include "emulator/loop/exposure_renderer.h"
#include "emulator/run/camera_station.h"

namespace hilcam {

struct FrameTime {
    double render_ms;  // from the world to the radiance image, on all threads
    double sensor_ms;  // from there to DN
    int threads;
};

// The time that a lens's stray light takes of a frame.
struct StrayTime {
    double ms;           // part of the sensor's time; may be negative where it cannot be told
    double resolved_ms;  // less than this cannot be told
    std::string parts;
};
// Returns how much longer the light of the first instant takes into the pixels with stray light than without, in turns, the
// shortest of three times each. None for a camera that has none. Owner thread; the station is loaded.
std::optional<StrayTime> stray_time(CameraStation& station, WorldState& world, ExposureRenderer& exposures);

// Returns medians of three frames behind a first one that is not counted. None where a frame has more than 32
// million primary rays, as at the quality `reference`: it would take minutes. Owner thread; the station is
// loaded.
std::optional<FrameTime> frame_time(CameraStation& station, WorldState& world, ExposureRenderer& exposures);

}  // namespace hilcam
