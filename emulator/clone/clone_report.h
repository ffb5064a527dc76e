#pragma once
// Reports of `hilcam clone`: a table for people, JSON for scripts and for the page that lays the real frames
// beside those of the emulated camera (tools/hilcam-plot-clone).

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "emulator/clone/clone_bench.h"
#include "emulator/clone/clone_camera.h"
#include "emulator/clone/clone_measurement.h"

namespace hilcam {

std::string clone_table(const CloneMeasurement& clone, const CameraModel& like);
// Returns figures {measured, uncertainty, sheet} (null: the frames do not show it), curves as lists of
// objects, histograms and spectrograms (EMVA 1288, section 8.7) of the maps, and the counts of defects.
nlohmann::json clone_json(const CloneMeasurement& clone, const CameraModel& like);

// Returns the series that the emulated camera has to take to be compared with these frames.
std::vector<BenchSeries> bench_series(const FrameSet& frames, const CloneMeasurement& clone);

// Writes clone.json of the frames, emulated.json of the camera in `camera_file` under the same series, and
// index.html, which hilcam-plot-clone makes of both. Throws DeviceError when a file cannot be written or that
// program fails.
void write_comparison(const CloneMeasurement& real, const FrameSet& frames, const CameraModel& like,
                      const std::filesystem::path& camera_file, const std::filesystem::path& folder);

}  // namespace hilcam
