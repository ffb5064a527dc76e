#pragma once
// The section of a scenario for the Earth's surface, clouds and lights beyond one albedo.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "render/vocabulary/config_field.h"

namespace hilcam {

// Clouds as they are at one instant.
struct CloudsConfig {
    std::filesystem::path map;
    std::string at_utc;
};
Fields fields(CloudsConfig& config);
void validate(const CloudsConfig& config);

struct EarthConfig {
    std::filesystem::path map;         // empty: the Earth is its albedo or albedo_map
    double wind_m_s = 7;               // at 12.5 m above all seas
    double cloud_thickness = 1;        // factor on their optical thickness; 0: none
    std::filesystem::path cloud_map;   // empty: those of `map`
    std::vector<CloudsConfig> clouds;  // by time, in place of cloud_map
    std::int64_t cloud_seed = 0;       // not 0: invented clouds in place of a map's
    double lights = 1;                 // factor on the cities' light at night
};
Fields fields(EarthConfig& config);
void validate(const EarthConfig& config);

}  // namespace hilcam
