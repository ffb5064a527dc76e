#include "emulator/scenario/exposure_config.h"

#include "emulator/scenario/app_config.h"

namespace hilcam {

ExposureConfig exposure_config_of(const ScenarioConfig& s) {
    return {.motion = s.quality.motion,
            .motion_error_px = s.quality.motion_error_px,
            .sampling = sampling_of(s),
            .has_terrain = s.terrain.has_value(),
            .seed = static_cast<std::uint64_t>(s.seed),
            .start = parse_utc(s.time_utc)};
}

}  // namespace hilcam
