#include "emulator/run/level_costs.h"

#include <algorithm>
#include <limits>

namespace hilcam {

double frame_ms(const TrialCost& cost, const FrameMachine& machine) {
    const double alone_ms =
        machine.prefer == LoopPreference::kLatency
            ? cost.render_ms + cost.sensor_ms
            : std::max({cost.render_ms, cost.sensor_ms, cost.core_ms / std::max(1, machine.threads)});
    return static_cast<double>(machine.cameras) * alone_ms;
}

std::vector<LevelCost> measure_levels(const std::vector<double>& rays, double enough_ms,
                                      const FrameMachine& machine,
                                      const std::function<TrialCost(std::size_t level)>& take) {
    constexpr double kLong_ms = 1000;
    std::vector<LevelCost> costs(rays.size());
    for (std::size_t level = 0; level < costs.size(); ++level) {
        if (rays[level] > kMaxTrialRays) {
            costs[level].frame_ms = std::numeric_limits<double>::infinity();
            continue;
        }
        // The first frame of a level also prepares later ones; where frames take long, that is a small part.
        TrialCost cost = take(level);
        if (cost.render_ms < kLong_ms) cost = take(level);
        costs[level] = {frame_ms(cost, machine), cost.core_ms};
        if (costs[level].frame_ms <= enough_ms) break;
    }
    return costs;
}

}  // namespace hilcam
