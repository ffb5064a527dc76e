#pragma once
// Which tiles of the Earth's finer levels a frame needs: those that may be in its field, at the levels that its pixels ask for. It is a
// function of the camera's place, attitude and field alone, so a frame is the same whatever was seen before.
//
// What rays see beside the field (by mirrors, as light on objects) is left to the levels that memory holds.

#include <vector>

#include "render/earth/earth_detail.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// A view is what a camera sees of the Earth, in the Earth's axes; directions are unit.
struct DetailView {
    Vec3d camera_m, boresight, sun_dir;
    double half_field_rad = 0;  // about the boresight; beyond it the camera sees nothing
    double pixel_rad = 0;
};

class DetailNeed {
  public:
    // most: tiles that there is room for.
    DetailNeed(const EarthDetail::Shape& shape, std::size_t most);

    // Finds the tiles, coarse ones first. Where there are more than `most`, all levels are taken coarser by halves of a level until
    // they fit. Loop; allocates nothing.
    void find(const DetailView& view);
    const std::vector<DetailKey>& tiles() const { return tiles_; }
    // Levels by which the last find() is coarser than pixels ask for; 0: by none.
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
