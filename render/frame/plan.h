#pragma once
// The requirement plan: what a frame needs, decided anew before each one, so that nothing else is computed.
// Each decision has its reason; `hilcam check` prints them.

#include <string>
#include <vector>

#include "render/frame/render_quality.h"
#include "render/scene/scene.h"
#include "render/shading/frame_context.h"

namespace hilcam {

enum class ObjectUse : std::uint8_t {
    kHidden,  // outside the field: casts shadow and is reflected, no ray of the camera looks for it
    kPoints,  // a few pixels or less: point sources with the flux of its own little picture
    kMesh     // traced
};

struct ObjectPlan {
    ObjectUse use = ObjectUse::kHidden;
    double distance_m = 0;     // distance of its middle from the camera
    double size_px = 0;        // size of the sphere that holds it
    std::size_t level = 0;     // level of detail; 0 is the mesh itself
    int samples_per_axis = 1;  // rays along a pixel of a traced object; a small one has more
    int point_samples = 0;     // rays along its little picture, of one that is drawn as points
    // Pixels across a picture of its own (object_impostor.h) from which its light comes; 0: none. Of a traced one the camera
    // finds what is seen and what it hides, and the light comes as points.
    int picture_px = 0;
};

// Distances of which the camera sees the objects; decides where ray space begins (frame_context.h).
struct RaySpace {
    Vec3d origin_world_m;
    double start_before_m = 0;  // 0: rays begin at the camera
};
// radius_m: of the sphere about each object's origin that holds it. rays_still: false keeps ray space at the
// camera.
RaySpace choose_ray_space(const WorldSnapshot& world, std::span<const double> radius_m, bool rays_still);

// An object this small is drawn as points: a single one below a pixel, a small cloud up to here. The regular
// grid of rays would miss parts of it, and differently from frame to frame.
inline constexpr double kPoints_px = 8.0;
// An object smaller than this may have a picture of its own, of so many pixels across where it is not drawn as points.
inline constexpr double kPictured_px = 64;
inline constexpr int kPicture_px = 128;
// The density that the quality asks for: rays along a pixel, the least number of rays across a traced object,
// and rays along the little picture of one that is drawn as points: as large as those are, and at least. And whether small objects have
// pictures of their own: those that are drawn as points, and traced ones.
struct RayDensity {
    int samples_per_axis;
    int rays_across;
    int point_samples = 0, min_point_samples = 0;
    bool pictures_of_points = false, pictures_of_meshes = false;
};

ObjectPlan plan_object(const ImageGeometry& geometry, const WorldSnapshot& world, const Pose& object,
                       double radius_m, RayDensity density);

// A frame that is planned, and what its plan is about.
struct PlannedFrame {
    const FrameContext& frame;
    std::span<const ObjectPlan> plans;  // per object, as the next two
    std::span<const std::string> names;
    std::span<const std::size_t> triangles;
    const RenderQuality& quality;
    std::size_t stars;
};
// The plan in words, a line each with its reason.
std::vector<std::string> explain(const PlannedFrame& planned, const WorldSnapshot& world);

}  // namespace hilcam
