#pragma once
// Maps of the ground as a scenario describes them: the file, the meaning of its values, and its placement on
// the body.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "render/ground/ground_surface.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

enum class MapHoles { kRefuse, kFill };
enum class MapCoding { kLinear, kSrgb };
enum class MapLatitudes { kLabel, kPlanetocentric, kPlanetographic };
enum class MapLongitudes { kLabel, kEast, kWest };

struct GroundMapConfig {
    std::filesystem::path file;
    std::string where;  // the key's place in the scenario
    GroundKind kind = GroundKind::kHeights;
    GroundBetween between = GroundBetween::kBilinear;
    double scale = 1;
    double offset = 0;
    MapCoding coding = MapCoding::kLinear;
    MapHoles holes = MapHoles::kRefuse;
    double blend_posts = 8;
    MapLatitudes latitudes = MapLatitudes::kLabel;
    MapLongitudes longitudes = MapLongitudes::kLabel;
    // Values of the file that are holes; empty: values that stand alone are judged (value_judge.h).
    std::vector<double> no_data;
    std::vector<double> bounds_deg;  // west, south, east, north; empty: the file's own projection
};
Fields fields(GroundMapConfig& config);
void validate(const GroundMapConfig& config);

// The body under a map.
struct MappedBody {
    std::string name;
    Figure figure;
};

// Opens a map; values are read when they are needed. Throws InputError, one line that names the file, when it
// is missing, has no known format, has no projection or another body's, or has holes that the config refuses.
GroundMap open_ground_map(const GroundMapConfig& config, const MappedBody& body);

}  // namespace hilcam
