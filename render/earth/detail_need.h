#pragma once
// Finds the tiles of the Earth's finer levels that a frame needs: those that may be in its field, at the
// levels that its pixels ask for. The result depends only on the camera's position, attitude and field, so a
// frame is the same whatever was shown before.
//
// Rays outside the field (by mirrors, or for light on objects) use the levels in memory.

#include <vector>

#include "render/earth/earth_detail.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// A camera's view of the Earth, in the Earth's axes; directions are unit vectors.
struct DetailView {
    Vec3d camera_m, boresight, sun_dir;
    double half_field_rad = 0;  // around the boresight; the camera sees nothing beyond
    double pixel_rad = 0;
};

class DetailNeed {
  public:
    // most: the number of tiles that fit into memory.
    DetailNeed(const EarthDetail::Shape& shape, std::size_t most);

    // Finds the tiles, coarse ones first. If there are more than `most`, all levels are made coarser in steps
    // of half a level until they fit. Loop; no allocation.
    void find(const DetailView& view);
    const std::vector<DetailKey>& tiles() const { return tiles_; }
    // Returns how many levels coarser than the pixels ask for the last find() is.
    double coarser_by() const { return coarser_by_; }

  private:
    struct Sight;
    EarthDetail::Shape shape_;
    std::size_t most_;
    double coarser_by_ = 0;
    std::vector<DetailKey> tiles_;

    bool collect(const Sight& sight);
    bool add_if_needed(const Sight& sight, const DetailKey& key);
};

}  // namespace hilcam
