#pragma once
// Maps of the ground as a scenario names them: which file, what its values mean, how it lies on the body.

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
    std::vector<double>
        no_data;  // values of the file that are holes; empty: those that stand alone, see value_judge.h
    std::vector<double> bounds_deg;  // west, south, east, north; empty: the file's own projection
};
Fields fields(GroundMapConfig& config);
void validate(const GroundMapConfig& config);

// The body under a map.
struct MappedBody {
    std::string name;
    Figure figure;
};

// Opens a map; what is looked at is read later. Throws InputError, one line that names the file: it is missing or of no
// known format, has no projection or one of another body, has holes that the config refuses.
GroundMap open_ground_map(const GroundMapConfig& config, const MappedBody& body);

}  // namespace hilcam
