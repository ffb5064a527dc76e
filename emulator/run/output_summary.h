#pragma once
// Summarises what happened to a run's frames at each output, with the same counters and one line for every
// kind of output.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "io/contract/frame_sink.h"

namespace hilcam {

class CameraStation;
struct RecorderReport;

std::vector<SinkReport> output_reports(const CameraStation& station);
// Returns a recording's report in the form of an output's: lost records count as dropped frames.
SinkReport output_report(const RecorderReport& recorder);

// {"name", "frames", "dropped", "unwanted"}
nlohmann::json counts_of(const SinkReport& output);
// {"source", "state", "scale", "offset_from_master_ns", "mean_path_delay_ns", "rate_correction_ppm", "steps",
// "master"}; null for what is not known.
nlohmann::json json_of(const ClockReport& clock);
// Returns "files out 16 frames, 14 lost; gige 127.0.0.1 28 frames, 2 that nobody took". Outputs without
// frames are left out.
std::string line_of(const std::vector<SinkReport>& outputs);
bool any_lost(const std::vector<SinkReport>& outputs);

}  // namespace hilcam
