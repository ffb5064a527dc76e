#pragma once
// What of the Earth's maps the looks of one frame are at.

namespace hilcam {

class DetailTiles;

struct EarthMoment {
    double cloud_number = 0;              // number of the clouds' map (CloudMaps::number_at)
    const DetailTiles* detail = nullptr;  // finer levels of the ground's map (detail_tiles.h); null: none
};

}  // namespace hilcam
