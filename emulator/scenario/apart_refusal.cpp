#include "emulator/scenario/apart_refusal.h"

#include "emulator/scenario/app_config.h"

namespace hilcam {

std::string apart_refusal(const ScenarioConfig& s, std::span<const RenderQuality> levels) {
    // To a scanning line exact is fast (exposure_renderer.h).
    if (s.quality.motion == MotionQuality::kExact && s.camera.shutter.kind != ShutterKind::kLineScan)
        return "quality.motion: found exact, which averages several instants; the light of one can be taken "
               "apart; accepted: fast, off";
    for (std::size_t i = 0; i < levels.size(); ++i)
        if (levels[i].noise_budget > 0)
            return (i == 0 ? "quality" : "loop.levels." + std::to_string(i - 1)) +
                   std::string(
                       ".noise_budget: found more than 0, which samples some pixels more often; "
                       "light can be taken apart where all are sampled alike; accepted: 0");
    return {};
}

}  // namespace hilcam
