#pragma once
// The ground of a whole body in a scenario: its maps, and the seeded detail that is finer than the maps.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/maps/ground_map_file.h"
#include "render/ground/boulder_field.h"
#include "render/ground/crater_field.h"
#include "render/ground/ground_relief.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

struct GlobeConfig {
    std::string body = "moon";
    std::vector<GroundMapConfig> maps;
    std::optional<ReliefSettings> relief;
    std::optional<CraterSettings> craters;
    std::optional<BoulderSettings> boulders;
    std::int64_t memory_mb = 512;
    double finest_m = 0.01;
};
Fields fields(GlobeConfig& globe);

}  // namespace hilcam
