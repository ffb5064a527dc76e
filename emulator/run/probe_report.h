#pragma once
// `hilcam prepare --probe OBJECT N`: what one probe of an object sees, as JSON (docs/rendering.md has the fields).

#include <cstdint>
#include <string>

#include "emulator/scenario/app_config.h"

namespace hilcam {

struct ProbeChoice {
    std::string object;        // its name in the scenario
    std::uint32_t number = 0;  // number of the probe, as `hilcam render --pixel` prints it
};

// Loads the scene of the scenario's first camera, making the object's table if it is not on disk, and returns the report.
// Throws InputError where there is no such object, where it has no table, or where it has fewer probes; and as load_scene().
std::string probe_report(const ScenarioConfig& scenario, const ProbeChoice& choice);

}  // namespace hilcam
