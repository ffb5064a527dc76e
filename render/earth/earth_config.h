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

// The surface as it is at one instant, or in the middle of a month of each year.
struct EarthGroundConfig {
    std::filesystem::path map;
    std::int64_t month = 0;  // 1: January; 0: at_utc says it
    std::string at_utc;
};
Fields fields(EarthGroundConfig& config);
void validate(const EarthGroundConfig& config);

// A map of one thing, to be read as it is looked at.
struct EarthLayerConfig {
    enum class Kind { kLand, kInfrared, kWater, kClouds, kCloudThickness, kCloudTops, kLights };
    enum class Coding { kLinear, kSrgb, kBlueMarble };
    std::filesystem::path file;
    std::string where;  // the key's place in the scenario
    Kind kind = Kind::kLand;
    Coding coding = Coding::kLinear;
    double scale = 1, offset = 0;
    std::vector<double> bounds_deg;  // edges of the whole Earth, as GroundMapConfig has them
};
Fields fields(EarthLayerConfig& config);
void validate(const EarthLayerConfig& config);

struct EarthConfig {
    std::filesystem::path map;              // empty: the Earth is its albedo or albedo_map
    double wind_m_s = 7;                    // at 12.5 m above all seas
    double cloud_thickness = 1;             // factor on their optical thickness; 0: none
    std::filesystem::path cloud_map;        // empty: those of `map`
    std::vector<CloudsConfig> clouds;       // by time, in place of cloud_map
    std::int64_t cloud_seed = 0;            // not 0: invented clouds in place of a map's
    double lights = 1;                      // factor on the cities' light at night
    std::vector<EarthGroundConfig> ground;  // by time, in place of the surface of `map`
    std::vector<EarthLayerConfig> layers;   // in place of those channels of `map`
    std::int64_t memory_mb = 256;           // for tiles of the layers, of each camera
};
Fields fields(EarthConfig& config);
void validate(const EarthConfig& config);

}  // namespace hilcam
