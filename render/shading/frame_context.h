#pragma once
// Everything that the rays of one frame share: scene, camera, background, quality.
//
// Ray space has world axes, metres, single precision, and its origin at `rays_world_m`. That is the camera,
// unless everything is far away compared with its size. Then the origin is a point among the objects, and the
// camera's rays start just in front of them, so that a target keeps its precision at any distance.

#include <array>
#include <vector>

#include "render/background/background.h"
#include "render/scene/color_bands.h"
#include "render/scene/embree_scene.h"
#include "render/scene/surface.h"
#include "render/shading/ray_generator.h"
#include "render/visibility/pixel_samples.h"
#include "render/visibility/screen_mask.h"
#include "render/vocabulary/image_geometry.h"
#include "render/vocabulary/pixel_box.h"
#include "render/vocabulary/random.h"

namespace hilcam {

class EarthImpostor;
class IndirectCache;
class Lamps;
class RadianceModel;
class VisibilityBuffer;

// Constant while a frame's tiles are traced.
struct FrameContext {
    const EmbreeScene* scene = nullptr;
    const std::vector<const ObjectSurfaces*>* objects = nullptr;  // each at its level of detail
    std::vector<Mat3f> world_from_body;                           // per object
    std::vector<std::uint8_t> is_point;  // per object: it is drawn as points, and camera rays pass through it
    // Per object: it has a cache of light from other surfaces and bodies.
    std::vector<std::uint8_t> is_cached;
    // Per object: it is dark in the frame's visibility buffer, because its impostor (object_impostor.h) draws
    // its light as points.
    std::vector<std::uint8_t> has_impostor;
    bool has_impostors = false;               // any of has_impostor
    const ScreenMask* object_mask = nullptr;  // pixels that may meet an object
    const VisibilityBuffer* visibility =
        nullptr;                               // visibility_buffer.h; null: rays find what the camera sees
    const VisibilityBuffer* ground = nullptr;  // buffer for ground alone (ground_light.h); null: none
    int ground_step_px = 1;                    // pixels between the places that are shaded
    PixelSamples samples;  // samples of the visibility buffer, or those that it would have
    const Background* background = nullptr;
    const RadianceModel* radiance = nullptr;
    const Lamps* lamps = nullptr;             // lamp_light.h; null: none
    const IndirectCache* indirect = nullptr;  // indirect_cache.h; null: the path model does not use it
    // Replaces the first body; null: that is computed pixel by pixel.
    const EarthImpostor* earth_impostor = nullptr;
    float earth_impostor_factor = 1;  // factor on the impostor's radiance, for the Sun's distance
    const ColorBands* bands = nullptr;
    const RayGenerator* rays = nullptr;
    ImageGeometry geometry;
    Vec3d rays_world_m;         // origin of ray space
    Vec3d camera_m;             // the camera in ray space
    double start_before_m = 0;  // > 0: the camera's rays start this far before start_at_m
    Vec3d start_at_m;           // in ray space
    int bins = 0;
    int max_depth = 1;
    float contribution_threshold = 0;
    bool sun_is_disk = false;  // sample the Sun's disk for shadows and highlights; otherwise use its middle
    bool has_glass = false;    // shadow rays must find out what they meet
    bool has_emission = false;
    // Directions of a path may meet lamps too, so both estimates are weighted.
    bool paths_sample_lobes = false;
    float alpha_behind_diffuse = 0;  // smallest alpha of facet lobes behind a diffuse bounce
    RandomKey key;
    bool bodies_may_hide = false;  // an object is so far away that a body may be in front of it
    std::array<PixelBox, kMaxBodies> body_boxes;  // pixels that may meet each body of disks() or its air
    std::size_t body_box_count = 0;
    PixelBox sun_box;  // pixels that may meet the Sun's disk

    bool may_see_body(const PixelBox& box) const {
        for (std::size_t i = 0; i < body_box_count; ++i)
            if (box.overlaps(body_boxes[i])) return true;
        return false;
    }
    // True when rays in the box can meet nothing but the background's plain body.
    bool sees_plain_body_only(const PixelBox& box) const {
        bool plain = false;
        for (std::size_t i = 0; i < body_box_count; ++i) {
            if (!box.overlaps(body_boxes[i])) continue;
            if (background->plain_body() != &background->disks()[i]) return false;
            plain = true;
        }
        return plain;
    }
    // True when rays in the box can meet nothing but the Earth's impostor.
    bool sees_earth_impostor_only(const PixelBox& box) const {
        if (!earth_impostor || box.overlaps(sun_box)) return false;
        for (std::size_t i = 1; i < body_box_count; ++i)
            if (box.overlaps(body_boxes[i])) return false;
        return box.overlaps(body_boxes[0]);
    }
    // Returns roughly how far the start of the camera's rays is from the camera [m].
    double way_to_start_m() const {
        return start_before_m > 0 ? std::max(0.0, length(start_at_m - camera_m) - start_before_m) : 0;
    }
    // Returns where a camera ray starts in ray space. from_camera_m is not zero if rows have their own poses.
    Vec3f start_of(Vec3d unit_dir, Vec3d from_camera_m = {}) const {
        const Vec3d eye_m = camera_m + from_camera_m;
        if (start_before_m <= 0) return to_float(eye_m);
        // The ray starts on the plane through start_at_m that faces it, less a margin. If that is behind the
        // eye, it starts at the eye.
        const double along_m = dot(start_at_m - eye_m, unit_dir) - start_before_m;
        return to_float(eye_m + std::max(0.0, along_m) * unit_dir);
    }
};

}  // namespace hilcam
