#pragma once
// `hilcam prepare --probe OBJECT N`: describes what one probe of an object sees, as JSON (fields:
// docs/rendering.md).

#include <cstdint>
#include <string>

#include "emulator/scenario/app_config.h"

namespace hilcam {

struct ProbeChoice {
    std::string object;        // name in the scenario
    std::uint32_t number = 0;  // number of the probe, as `hilcam render --pixel` prints it
};

// Loads the scene of the scenario's first camera, makes the object's table if it is not on disk, and returns
// the report. Throws InputError when there is no such object, when it has no table, or too few probes; also
// what load_scene() throws.
std::string probe_report(const ScenarioConfig& scenario, const ProbeChoice& choice);

}  // namespace hilcam
