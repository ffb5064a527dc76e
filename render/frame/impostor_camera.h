#pragma once
// The camera that looks at one object alone, so that the sphere which holds it fills a picture; and the points that such a picture is
// drawn as: its light is added up in cells of a fraction of a pixel of the frame, each a point at the middle of its light. So the flux
// is that of the object at its phase and attitude, however small it is, and its centroid does not jump from pixel to pixel.

#include <memory>
#include <span>

#include "render/frame/plan.h"
#include "render/shading/frame_context.h"

namespace hilcam {

// Light of a cell.
struct Glimpse {
    Vec3d world_dir;              // unit, of its middle
    Spectrum irradiance_w_m2_um;  // at the camera, per bin
};

class ImpostorCamera {
  public:
    // picture_px: sides of its largest picture. The frame's view must have its pointers and sizes by now. Owner thread.
    ImpostorCamera(const FrameContext& frame, int picture_px);

    // Takes over what a frame has placed. Loop, as all that follows.
    void begin(const FrameContext& frame);
    // Looks at object `i`, of a sphere of radius_m, in the middle of a picture of picture_px, of which the sphere fills sphere_px. Only
    // where the boxes of the object's triangles are anything is marked as seen.
    void aim(const WorldSnapshot& world, std::size_t i, double distance_m, double radius_m, int picture_px,
             int sphere_px);
    void look_away(std::size_t i) { view_.is_point[i] = 1; }

    FrameContext& view() { return view_; }
    const FrameContext& view() const { return view_; }
    const Pose& camera() const { return camera_; }

    // Adds up a picture, row by row, in cells x cells parts of the middle where the sphere is; room for as many glimpses. Returns how many
    // have any light.
    std::size_t find_glimpses(std::span<const Spectrum> picture, int sphere_px, int cells,
                              Glimpse* glimpses) const;
    // Returns the number of cells across an object: half a pixel of the frame each.
    static int cells_across(const ObjectPlan& plan);
    // Returns the distance at which what is in its way is before the object [m].
    static double before_m(const ObjectPlan& plan, double radius_m);

  private:
    std::unique_ptr<RayGenerator> rays_;
    ScreenMask mask_;
    FrameContext view_;
    Pose camera_;
    Mat3d world_from_view_;

    void mark(const Pose& object, std::span<const std::array<Vec3f, 2>> boxes_m);
};

}  // namespace hilcam
