#pragma once
// The little picture of an object that is a few pixels wide or less: traced with rays of its own, added up in
// cells of a fraction of a pixel, each a point at the middle of its light. So its flux is that of the object
// at its phase and attitude, however small it is, and its centroid does not jump from pixel to pixel.

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "render/frame/plan.h"
#include "render/light/frame_view.h"
#include "render/light/path_model.h"

namespace hilcam {

class ObjectProbe {
  public:
    static constexpr int kMaxCells = 16;  // along an axis: an object gives at most the square of it of points

    // Light of a cell.
    struct Glimpse {
        Vec3d world_dir;              // unit, of its middle
        Spectrum irradiance_w_m2_um;  // at the camera, per bin
    };

    // most_samples: rays along an axis of the largest picture. The frame's view must have its pointers and sizes by
    // now. Owner thread.
    ObjectProbe(const FrameView& frame, int most_samples);

    // Takes over what a frame has placed. Loop, as all that follows.
    void begin(const FrameView& frame);
    // Finds the light of object `i`, of a sphere of radius_m, cell by cell. glimpses: room for cells_across()^2.
    // Returns how many have any; adds to stats what it took to trace.
    std::size_t look(const WorldSnapshot& world, std::size_t i, const ObjectPlan& plan, double radius_m,
                     PathModel& paths, Glimpse* glimpses, TileStats& stats);
    static int cells_across(const ObjectPlan& plan);
    // Returns the distance at which what is in its way is before the object [m].
    static double before_m(const ObjectPlan& plan, double radius_m);

  private:
    int samples_;  // rays along an axis of the present picture
    std::unique_ptr<RayGenerator> rays_;
    ScreenMask mask_;
    FrameView view_;
    Mat3d world_from_view_;
    std::vector<Spectrum> tile_, picture_;
    std::unique_ptr<FacetList> facets_ = std::make_unique<FacetList>();

    void aim(const WorldSnapshot& world, std::size_t i, double distance_m, double radius_m);
    void mark(const Pose& camera, const Pose& object, std::span<const std::array<Vec3f, 2>> boxes_m);
    TileStats trace(PathModel& paths);
};

}  // namespace hilcam
