#pragma once
// A scenario's section for the Earth's surface, clouds and lights beyond a single albedo.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "render/vocabulary/config_field.h"

namespace hilcam {

// Clouds at one instant.
struct CloudsConfig {
    std::filesystem::path map;
    std::string at_utc;
};
Fields fields(CloudsConfig& config);
void validate(const CloudsConfig& config);

// The surface at one instant, or in the middle of one month of every year.
struct EarthGroundConfig {
    std::filesystem::path map;
    std::int64_t month = 0;  // 1: January; 0: at_utc gives the time
    std::string at_utc;
};
Fields fields(EarthGroundConfig& config);
void validate(const EarthGroundConfig& config);

// A map of one quantity, read on demand.
struct EarthLayerConfig {
    enum class Kind { kLand, kInfrared, kWater, kClouds, kCloudThickness, kCloudTops, kLights };
    enum class Coding { kLinear, kSrgb, kBlueMarble };
    std::filesystem::path file;
    std::string where;  // place of the key in the scenario
    Kind kind = Kind::kLand;
    Coding coding = Coding::kLinear;
    double scale = 1, offset = 0;
    std::vector<double> bounds_deg;  // edges, for a map of the whole Earth, as in GroundMapConfig
};
Fields fields(EarthLayerConfig& config);
void validate(const EarthLayerConfig& config);

struct EarthConfig {
    std::filesystem::path map;              // empty: the Earth has `albedo` or `albedo_map`
    double wind_m_s = 7;                    // at 12.5 m above all seas
    double cloud_thickness = 1;             // factor on the clouds' optical thickness; 0: no clouds
    std::filesystem::path cloud_map;        // empty: the clouds of `map`
    std::vector<CloudsConfig> clouds;       // by time; replace cloud_map
    std::int64_t cloud_seed = 0;            // not 0: invented clouds replace those of a map
    double lights = 1;                      // factor on the light of cities at night
    std::vector<EarthGroundConfig> ground;  // by time; replace the surface of `map`
    std::vector<EarthLayerConfig> layers;   // replace those channels of `map`
    std::int64_t memory_mb = 256;           // for tiles of the layers, per camera
};
Fields fields(EarthConfig& config);
void validate(const EarthConfig& config);

}  // namespace hilcam
