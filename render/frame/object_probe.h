#pragma once
// The little picture of an object that is a few pixels wide or less: traced with rays of its own, added up in
// cells of a fraction of a pixel, each a point at the middle of its light. So its flux is that of the object
// at its phase and attitude, however small it is, and its centroid does not jump from pixel to pixel.

#include <memory>
#include <vector>

#include "render/frame/plan.h"
#include "render/light/frame_view.h"
#include "render/light/path_model.h"
#include "render/light/point_field.h"

namespace hilcam {

class ObjectProbe {
  public:
    static constexpr int kMaxCells = 16;  // along an axis: an object gives at most the square of it of points

    // samples: rays along an axis of the picture. The frame's view must have its pointers and sizes by now.
    ObjectProbe(const FrameView& frame, int samples);

    // Adds the points of object `i`, of a sphere of radius_m, as the frame sees it. Loop; no allocation while
    // the vector has room. Returns what it took to trace.
    TileStats add_points(const FrameView& frame, const WorldSnapshot& world, std::size_t i,
                         const ObjectPlan& plan, double radius_m, PathModel& paths, const PointField& field,
                         std::vector<PointSource>& points);

  private:
    int samples_;
    std::unique_ptr<RayGenerator> rays_;
    ScreenMask mask_;
    FrameView view_;
    Mat3d world_from_view_;
    std::vector<Spectrum> tile_, picture_;
    std::unique_ptr<FacetList> facets_ = std::make_unique<FacetList>();

    void aim(const FrameView& frame, const WorldSnapshot& world, std::size_t i, double distance_m,
             double radius_m);
    TileStats trace(PathModel& paths);
};

}  // namespace hilcam
