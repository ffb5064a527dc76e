#pragma once
// The quality levels that the governor (governor.h) chooses from: level 0 is the scenario's `quality`, each
// further one says what is different in it and is faster than the one before.
//
// Only what may change from one frame to the next is in a level. Without `loop.levels` the ladder is the
// program's own (built_in_levels).

#include <map>
#include <string>
#include <vector>

#include "emulator/scenario/real_time.h"
#include "render/frame/render_quality.h"
#include "render/vocabulary/config_field.h"
#include "sensor/exposure.h"

namespace hilcam {

// Keys that are not given are as in `quality`.
struct QualityLevelConfig {
    RenderQuality values;
    std::map<std::string, bool> given;  // by key
};
Fields fields(QualityLevelConfig& level);

inline constexpr std::size_t kMaxLevels = 16;  // includes level 0

// The aim of the frame loop (frame_loop.h).
enum class LoopPreference { kThroughput, kLatency };

struct LoopConfig {
    static constexpr double kBudgetOfRate_s = -1;

    LoopPreference prefer = LoopPreference::kThroughput;
    bool wait_for_light = false;
    double frame_budget_s = kBudgetOfRate_s;  // 0: no governor
    std::vector<QualityLevelConfig> levels;
    bool levels_fixed = false;  // every frame has the configured quality
    RealTime real_time;
    // No key, but for who runs the scenario: frames have to come at the camera's rate, so that a budget of the rate
    // counts.
    bool holds_rate = false;

    bool budget_is_of_rate() const { return frame_budget_s < 0; }
};
Fields fields(LoopConfig& loop);
void validate(const LoopConfig& loop);

// The keys of a quality that may change from one frame to the next (render/frame/render_quality.cpp).
Fields per_frame_fields(RenderQuality& quality);

RenderQuality applied(const RenderQuality& configured, const QualityLevelConfig& level);

// Steps down from a quality, each as far as it makes anything faster: towards configs/quality/fast.yaml,
// then coarser meshes, no bounce, direct light alone. Sixteen samples a pixel stay where there is a
// visibility buffer. For ground that is alone in the scene: to every second pixel of it.
std::vector<RenderQuality> built_in_levels(const RenderQuality& configured);

// Returns how that quality places its rays in a pixel.
RayGrid ray_grid_of(const RenderQuality& quality);
// Says what changes from one to the other, for people: "max_depth 1, lod_error_px 2".
std::string difference(const RenderQuality& from, const RenderQuality& to);

}  // namespace hilcam
