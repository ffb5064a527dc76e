#pragma once
// Measures how long a frame of the first instant takes on this machine, for `hilcam check`. `hilcam bench`
// measures it more thoroughly: around the target, paced, with its spread.

#include <optional>
#include <string>

#include "emulator/loop/exposure_renderer.h"
#include "emulator/run/camera_station.h"

namespace hilcam {

struct FrameTime {
    double render_ms;  // from the world to the radiance image, on all threads
    double sensor_ms;  // from the radiance image to DN
    int threads;
};

// The part of a frame's time that the lens's stray light takes.
struct StrayTime {
    double ms;           // part of the sensor's time; may be negative when it is below resolved_ms
    double resolved_ms;  // smallest difference that the measurement resolves
    std::string parts;
};
// Measures how much longer the sensor takes with stray light than without, for the light of the first
// instant. Both are timed in turns, three times each, and the shortest times count. Returns nothing for a
// camera without stray light, or when a frame has more rays than frame_time() accepts. Owner thread; the
// station is loaded.
std::optional<StrayTime> stray_time(CameraStation& station, WorldState& world, ExposureRenderer& exposures);

// Returns medians of three frames, after a first one that is not counted. Returns nothing when a frame has
// more than 32 million primary rays, as with quality `reference`, because that would take minutes. Owner
// thread; the station is loaded.
std::optional<FrameTime> frame_time(CameraStation& station, WorldState& world, ExposureRenderer& exposures);

}  // namespace hilcam
