#pragma once
// Says how fast a run's frames came, what held them up, which quality they had, and what full quality would need.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "emulator/run/camera_station.h"

namespace hilcam {

// Says what full quality takes of a machine that holds the camera's rate.
struct FullQuality {
    double core_ms = 0;  // processor time of a frame, of all threads of the program
    double rate_hz = 0;  // the camera's rate, in the machine's time
    double cores() const { return 1e-3 * core_ms * rate_hz; }
};

// Returns what a frame of level 0 costs: by the run's own frames of that level where it had some, else by the cost before
// the run and by how much more than theirs the run's frames took; nothing where neither is known. Any thread.
std::optional<double> full_quality_core_ms(const LoopCounters& counters,
                                           const std::vector<LevelCost>& level_costs);
// The same with the rate; nothing as well where no clock asks for frames.
std::optional<FullQuality> full_quality(const CameraStation& station);

// Names what frames wait for. A run that hardly misses exposures waits for the camera's own rate, or for who asks for frames.
enum class PaceLimit { kCommands, kTriggers, kFrameRate, kRendering, kSensor, kOutputs };
std::string_view words_of(PaceLimit limit);
struct Misses {
    std::uint64_t frames = 0, missed = 0;
};
// Returns what frames of such times wait for. cause: who asks for frames while all are taken.
PaceLimit pace_limit(const Misses& misses, const StageMeters& meters, PaceLimit cause);
PaceLimit pace_limit(const CameraStation& station, const Misses& misses);

// Returns how many cores the program's threads may have.
int given_cores();

// "level 0: 12 frames, level 3: 586 frames; full quality takes ..."; empty where all frames had the configured quality and
// none was missed. Owner thread.
std::string quality_line(const CameraStation& station);

}  // namespace hilcam
