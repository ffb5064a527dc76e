#pragma once
// A camera for the picture of one object, which the object's bounding sphere fills, and the points that such
// a picture becomes. Its light is summed in cells of a fraction of a frame pixel, and each cell is a point at
// the centroid of its light. So the flux is right for the object's phase and attitude however small it is,
// and its centroid does not jump from pixel to pixel.

#include <memory>
#include <span>

#include "render/frame/plan.h"
#include "render/shading/frame_context.h"

namespace hilcam {

// The light of a cell.
struct Glimpse {
    Vec3d world_dir;              // unit, to the centroid
    Spectrum irradiance_w_m2_um;  // at the camera, per bin
};

class ImpostorCamera {
  public:
    // picture_px: side of the largest picture. The frame context must have its pointers and sizes already.
    // Owner thread.
    ImpostorCamera(const FrameContext& frame, int picture_px);

    // Copies the state of a placed frame. Loop, like all functions below.
    void begin(const FrameContext& frame);
    // Aims at object `i` with a bounding sphere of radius_m, in the middle of a picture of picture_px of
    // which the sphere fills sphere_px. Marks only the pixels that the boxes of the object's triangles cover.
    void aim(const WorldSnapshot& world, std::size_t i, double distance_m, double radius_m, int picture_px,
             int sphere_px);
    void look_away(std::size_t i) { view_.is_point[i] = 1; }

    FrameContext& view() { return view_; }
    const FrameContext& view() const { return view_; }
    const Pose& camera() const { return camera_; }

    // Sums a picture, stored row by row, in cells x cells parts of the middle where the sphere is. `glimpses`
    // must have room for cells x cells entries. Returns the number of cells that have light.
    std::size_t find_glimpses(std::span<const Spectrum> picture, int sphere_px, int cells,
                              Glimpse* glimpses) const;
    // Returns the number of cells across an object; each is half a pixel of the frame.
    static int cells_across(const ObjectPlan& plan);
    // Returns how far in front of the object something has to be to cover it [m].
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
