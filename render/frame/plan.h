#pragma once
// The plan: what a frame needs, decided anew before each one so that nothing else is computed. Each decision
// has its reason, which `hilcam check` prints.

#include <string>
#include <vector>

#include "render/frame/render_quality.h"
#include "render/scene/scene.h"
#include "render/shading/frame_context.h"

namespace hilcam {

enum class ObjectUse : std::uint8_t {
    kHidden,  // outside the field: it casts shadows and is reflected, but no camera ray looks for it
    kPoints,  // a few pixels or less: point sources with the flux of its own small picture
    kMesh     // traced
};

struct ObjectPlan {
    ObjectUse use = ObjectUse::kHidden;
    double distance_m = 0;     // from the camera to its middle
    double size_px = 0;        // diameter of the sphere that holds it
    std::size_t level = 0;     // level of detail; 0 is the full mesh
    int samples_per_axis = 1;  // rays along one axis of a pixel; more for a small object
    int point_samples = 0;     // rays along one axis of its small picture, if it is drawn as points
    // Pixels across its impostor (object_impostor.h), whose light replaces that of the object; 0: none. If
    // the object is also traced, the camera's rays find only what is visible and what it hides.
    int picture_px = 0;
};

// Where ray space begins (frame_context.h), chosen by the distances of the objects that the camera sees.
struct RaySpace {
    Vec3d origin_world_m;
    double start_before_m = 0;  // 0: rays begin at the camera
};
// radius_m: of the sphere about each object's origin that holds it. rays_still: false keeps ray space at the
// camera.
RaySpace choose_ray_space(const WorldSnapshot& world, std::span<const double> radius_m, bool rays_still);

// An object below this size is drawn as points: one point below a pixel, a small cloud up to here. The
// regular grid of rays would miss parts of it, and other parts in each frame.
inline constexpr double kPoints_px = 8.0;
// An object below this size may have an impostor; it has this many pixels across unless the object is drawn
// as points.
inline constexpr double kPictured_px = 64;
inline constexpr int kPicture_px = 128;
// The sampling that the quality asks for: rays along one axis of a pixel, the least number of rays across a
// traced object, and rays along one axis of the small picture of an object that is drawn as points (for the
// largest such object, and at least). Also whether objects that are drawn as points, and small traced ones,
// have impostors.
struct RayDensity {
    int samples_per_axis;
    int rays_across;
    int point_samples = 0, min_point_samples = 0;
    bool pictures_of_points = false, pictures_of_meshes = false;
};

ObjectPlan plan_object(const ImageGeometry& geometry, const WorldSnapshot& world, const Pose& object,
                       double radius_m, RayDensity density);

// A planned frame and what its plan is about.
struct PlannedFrame {
    const FrameContext& frame;
    std::span<const ObjectPlan> plans;  // one per object, like the next two
    std::span<const std::string> names;
    std::span<const std::size_t> triangles;
    const RenderQuality& quality;
    std::size_t stars;
};
// Returns the plan in words: one line for each decision, with its reason.
std::vector<std::string> explain(const PlannedFrame& planned, const WorldSnapshot& world);

}  // namespace hilcam
