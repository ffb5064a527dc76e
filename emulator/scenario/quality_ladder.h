#pragma once
// The quality levels that the governor (governor.h) chooses from. Level 0 is the scenario's `quality`; each
// further level states its differences from it and is faster than the one before.
//
// A level contains only what may change between frames. Without `loop.levels`, the program's own levels are
// used (built_in_levels).

#include <map>
#include <string>
#include <vector>

#include "emulator/scenario/real_time.h"
#include "emulator/scenario/run_bounds.h"
#include "render/frame/render_quality.h"
#include "render/vocabulary/config_field.h"
#include "sensor/exposure.h"

namespace hilcam {

// Keys that are not given have the value in `quality`.
struct QualityLevelConfig {
    RenderQuality values;
    std::map<std::string, bool> given;  // by key
};
Fields fields(QualityLevelConfig& level);

inline constexpr std::size_t kMaxLevels = 16;  // including level 0

// The aim of the frame loop (frame_loop.h).
enum class LoopPreference { kThroughput, kLatency };

struct LoopConfig {
    static constexpr double kBudgetOfRate_s = -1;

    LoopPreference prefer = LoopPreference::kThroughput;
    bool wait_for_light = false;
    double frame_budget_s = kBudgetOfRate_s;  // 0: no governor
    std::vector<QualityLevelConfig> levels;
    bool levels_fixed = false;  // true: every frame has the configured quality
    RealTime real_time;
    RunBounds fail_on;
    // Not a key: true when the run's frames must come at the camera's rate, so that a budget derived from the
    // rate applies.
    bool holds_rate = false;

    bool budget_is_of_rate() const { return frame_budget_s < 0; }
};
Fields fields(LoopConfig& loop);
void validate(const LoopConfig& loop);

// The quality keys that may change between frames (render/frame/render_quality.cpp).
Fields per_frame_fields(RenderQuality& quality);

RenderQuality applied(const RenderQuality& configured, const QualityLevelConfig& level);

// Returns steps down from a quality, leaving out those that change nothing: towards
// configs/quality/fast.yaml, then coarser meshes, no bounce, direct light alone. A visibility buffer then has
// at most sixteen samples a pixel. For a scene of ground alone, the only step is to shade every second pixel.
std::vector<RenderQuality> built_in_levels(const RenderQuality& configured);

// Returns how rays are placed within a pixel at that quality.
RayGrid ray_grid_of(const RenderQuality& quality);
// Describes the changes from one quality to another, for people: "max_depth 1, lod_error_px 2".
std::string difference(const RenderQuality& from, const RenderQuality& to);

}  // namespace hilcam
