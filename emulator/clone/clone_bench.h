#pragma once
// An emulated camera on the optical bench (emulator/characterise/camera_bench.h) that is given the settings
// of somebody's series of frames: the same exposures, temperatures and numbers of frames, and flats that are
// as bright. What `hilcam clone` measures of these frames stands beside what it measured of the real ones.

#include <cstdint>
#include <memory>
#include <vector>

#include "emulator/clone/frame_set.h"
#include "sensor/camera_model.h"

namespace hilcam {

// One series to take. charge_e: mean charge of the light in a pixel, at the middle of the plate; 0: dark.
struct BenchSeries {
    FrameSeries settings;  // without read
    double charge_e = 0;
};

// Returns the frames of that camera, which are made when they are asked for. The same seed gives the same
// frames. Throws InputError as SensorChain does.
FrameSet bench_frames(const CameraModel& camera, const DetectorPictures& pictures,
                      const std::vector<BenchSeries>& series, std::uint64_t seed);

// Returns the camera as it is on the bench: the whole sensor, nothing that belongs to a spacecraft.
CameraModel on_clone_bench(CameraModel camera);

}  // namespace hilcam
