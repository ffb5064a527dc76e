#include "emulator/scenario/apart_refusal.h"

#include "emulator/scenario/app_config.h"

namespace hilcam {

std::string apart_refusal(const ScenarioConfig& s) {
    // For a line scanner, exact motion is the same as fast (exposure_renderer.h).
    if (s.quality.motion == MotionQuality::kExact && s.camera.shutter.kind != ShutterKind::kLineScan)
        return "quality.motion: found exact, which averages several instants; the light of one can be taken "
               "apart; accepted: fast, off";
    return {};
}

}  // namespace hilcam
