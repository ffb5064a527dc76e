#pragma once
// The state of the Earth's maps for one frame.

namespace hilcam {

class DetailTiles;

// An instant's position between maps: the integer part is the number of the earlier map, the fraction the
// weight of the next one.
struct MapNumbers {
    double clouds = 0;  // CloudMaps
    double ground = 0;  // GroundMaps
};

struct EarthMoment {
    MapNumbers number;
    const DetailTiles* detail = nullptr;  // finer levels of the ground's map (detail_tiles.h); null: none
};

}  // namespace hilcam
