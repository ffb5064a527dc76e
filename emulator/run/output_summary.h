#pragma once
// Says what has become of a run's frames in each output: one set of counters and one line, whatever the output is.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "io/contract/frame_sink.h"

namespace hilcam {

class CameraStation;
struct RecorderReport;

std::vector<SinkReport> output_reports(const CameraStation& station);
// A recording as an output among the others: records that it lost are its dropped frames.
SinkReport output_report(const RecorderReport& recorder);

// {"name", "frames", "dropped", "unwanted"}
nlohmann::json counts_of(const SinkReport& output);
// "files out 16 frames, 14 lost; gige 127.0.0.1 28 frames, 2 that nobody took"; outputs that had no frame are left out.
std::string line_of(const std::vector<SinkReport>& outputs);
bool any_lost(const std::vector<SinkReport>& outputs);

}  // namespace hilcam
