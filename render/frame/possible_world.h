#pragma once
// The last guard before the acceleration structure, which ends the program at a place that is no number: what of a world cannot be
// (motion_bounds.h) is left out of the frame. The emulator lets none through (WorldState); frames are asked for by others, too.

#include <cstdint>
#include <vector>

#include "render/scene/scene.h"

namespace hilcam {

class PossibleWorld {
  public:
    // objects: most that a world has. Owner thread.
    explicit PossibleWorld(std::size_t objects);

    // Takes a world: an object that cannot be is left out; a camera and bodies that cannot stay as they were. Loop; nothing is allocated
    // after the first call.
    void take(const WorldSnapshot& world);

    const WorldSnapshot& world() const { return world_; }
    WorldSnapshot& world() { return world_; }
    bool is_left_out(std::size_t object) const { return is_left_out_[object] != 0; }
    // Returns how much of the world could not be.
    std::uint64_t left_out() const { return left_out_; }
    // Puts what is left out nowhere, where no ray meets it, and back to far behind the camera, for all that reckons with places.
    void hide_from_rays();
    void put_away();

  private:
    WorldSnapshot world_;
    std::vector<std::uint8_t> is_left_out_;  // per object
    std::uint64_t left_out_ = 0;

    void move_left_out(Vec3d place_m);
};

}  // namespace hilcam
