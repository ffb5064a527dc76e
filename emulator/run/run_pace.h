#pragma once
// Says how fast a run's frames came, what limited them, which quality they had, and what full quality would
// need.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "emulator/run/camera_station.h"

namespace hilcam {

// The computing power for full quality at the camera's rate.
struct FullQuality {
    double core_ms = 0;  // processor time of a frame, over all threads of the program
    double rate_hz = 0;  // camera's frame rate in the machine's time
    double cores() const { return 1e-3 * core_ms * rate_hz; }
};

// Returns what a frame of level 0 costs: from the run's own frames of that level, or else from the cost
// before the run scaled by how much longer than expected the run's frames took. Returns nothing when neither
// is known. Any thread.
std::optional<double> full_quality_core_ms(const LoopCounters& counters,
                                           const std::vector<LevelCost>& level_costs);
// Returns the same with the rate. Also returns nothing when frames do not come at a rate of their own.
std::optional<FullQuality> full_quality(const CameraStation& station);

// The limit on the rate of frames. When hardly any exposure is missed, that is the camera's own rate, or the
// client that requests frames.
enum class PaceLimit { kCommands, kTriggers, kFrameRate, kRendering, kSensor, kOutputs };
std::string_view words_of(PaceLimit limit);
struct Misses {
    std::uint64_t frames = 0, missed = 0;
};
// Returns what limits the rate, from times of the stages. cause: what requests frames, for the case that none
// are missed.
PaceLimit pace_limit(const Misses& misses, const StageMeters& meters, PaceLimit cause);
PaceLimit pace_limit(const CameraStation& station, const Misses& misses);

// Returns how many cores the program's threads may use.
int given_cores();

// Returns "level 0: 12 frames, level 3: 586 frames; full quality takes ..."; empty when all frames had the
// configured quality and none was missed. Owner thread.
std::string quality_line(const CameraStation& station);

}  // namespace hilcam
