#pragma once
// A moment is what of the Earth's maps the looks of one frame are at.

namespace hilcam {

class DetailTiles;

// Where an instant lies between maps: the number of the one before it, with the share of the one after it behind the point.
struct MapNumbers {
    double clouds = 0;  // CloudMaps
    double ground = 0;  // GroundMaps
};

struct EarthMoment {
    MapNumbers number;
    const DetailTiles* detail = nullptr;  // finer levels of the ground's map (detail_tiles.h); null: none
};

}  // namespace hilcam
