#pragma once
// Judges a run that has ended by the bounds of its scenario (`loop.fail_on`, emulator/scenario/run_bounds.h).
// Every camera has to keep them.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "emulator/run/camera_station.h"

namespace hilcam {

struct BrokenBound {
    std::string key;              // without "loop.fail_on."
    std::string camera;           // its name
    std::optional<double> value;  // in the key's unit; nothing: there was no frame to measure it on
    double bound = 0;
    std::uint64_t first_frame = 0;  // the first frame that broke it; 0: not known
    std::uint64_t count = 0;        // frames, exposures or packets that broke it
};

// The figures of a camera's run that bounds are for.
struct BoundedFigures {
    FramesAbove latency, p999, exposure;
    std::uint64_t judged_commands = 0, judged_exposures = 0;  // frames that were measured
    double p999_ms = 0;
    std::uint64_t missed = 0, first_missed = 0;
    std::uint64_t packets = 0, first_packet_frame = 0;
    std::uint64_t frames = 0, first_dropped = 0;
};
BoundedFigures bounded_figures(const CameraStation& station);

std::vector<BrokenBound> broken_bounds(const RunBounds& bounds, const std::string& camera,
                                       const BoundedFigures& figures);
// Returns those of all cameras of a run.
std::vector<BrokenBound> broken_bounds(const std::vector<std::unique_ptr<CameraStation>>& stations);

// Returns "loop.fail_on.latency_ms: camera wide: 12.5 ms, 10 ms are allowed: first in frame 41, 3 frames in
// all".
std::string text_of(const BrokenBound& broken);
nlohmann::json failed_on_json(const std::vector<BrokenBound>& broken);
// Returns the bounds that are set, by key.
nlohmann::json bounds_json(const RunBounds& bounds);

}  // namespace hilcam
