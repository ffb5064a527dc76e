#pragma once
// The last check before the acceleration structure, which ends the program at a position that is not finite.
// It leaves impossible things of a world (motion_bounds.h) out of the frame. The emulator's WorldState lets
// none through, but others may ask for frames, too.

#include <cstdint>
#include <vector>

#include "render/scene/scene.h"

namespace hilcam {

class PossibleWorld {
  public:
    // objects: the largest number in a world. Owner thread.
    explicit PossibleWorld(std::size_t objects);

    // Takes a world. An impossible object is left out; an impossible camera or body keeps its last state.
    // Loop; no allocation after the first call.
    void take(const WorldSnapshot& world);

    const WorldSnapshot& world() const { return world_; }
    WorldSnapshot& world() { return world_; }
    bool is_left_out(std::size_t object) const { return is_left_out_[object] != 0; }
    // Returns how many things have been left out as impossible so far.
    std::uint64_t left_out() const { return left_out_; }
    // Moves objects that are left out to nowhere, so that no ray meets them; and back to far behind the
    // camera, for code that computes with positions.
    void hide_from_rays();
    void put_away();

  private:
    WorldSnapshot world_;
    std::vector<std::uint8_t> is_left_out_;  // per object
    std::uint64_t left_out_ = 0;

    void move_left_out(Vec3d place_m);
};

}  // namespace hilcam
