#pragma once
// The part of a run's report that says how late its frames were: the times of each step from a command to a
// frame's last packet, the latest frames, and the exposures that were missed (docs/program.md).

#include <nlohmann/json_fwd.hpp>

#include "emulator/run/camera_station.h"

namespace hilcam {

// Returns percentiles, number of records and records by quarters of an octave, all in ms.
nlohmann::json durations_json(const DurationHistogram& histogram);
// Returns the steps' durations, by name.
nlohmann::json latency_json(const DeliveryMeter& delivery);
nlohmann::json missed_json(const MissedExposures& missed, std::uint64_t total);
// Returns the latest frames by their time from the command and by their time from the exposure; read when the
// station's outputs are stopped.
nlohmann::json latest_frames_json(const CameraStation& station);

}  // namespace hilcam
