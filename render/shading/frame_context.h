#pragma once
// Everything that the rays of one frame share: scene, camera, background, quality.
//
// Ray space: world axes, metres, single precision, counted from `rays_world_m`. That is the camera, unless
// everything is far away against its own size: then it is a point amid the objects, and the camera's rays
// begin just before them, so that a target keeps its digits at any distance.

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
    std::vector<std::uint8_t> is_point;   // per object: drawn as a point, the camera's rays pass it
    std::vector<std::uint8_t> is_cached;  // per object: light from other surfaces and bodies is cached on it
    // Per object: where the frame's visibility buffer sees it, it is dark, as its light comes as points (object_impostor.h).
    std::vector<std::uint8_t> has_impostor;
    bool has_impostors = false;               // any of them
    const ScreenMask* object_mask = nullptr;  // pixels that can meet an object
    const VisibilityBuffer* visibility =
        nullptr;  // visibility_buffer.h; null: rays find what the camera sees
    const VisibilityBuffer* ground =
        nullptr;             // buffer of ground that alone is seen (ground_light.h); null: likewise
    int ground_step_px = 1;  // pixels between the places that it sees
    PixelSamples samples;    // those of the visibility buffer, or that it would have
    const Background* background = nullptr;
    const RadianceModel* radiance = nullptr;
    const Lamps* lamps = nullptr;                   // lamp_light.h; null: none
    const IndirectCache* indirect = nullptr;        // indirect_cache.h; null: the path model does without
    const EarthImpostor* earth_impostor = nullptr;  // the first body's; null: it is worked out pixel by pixel
    float earth_impostor_factor = 1;                // on its radiance, by the Sun's distance
    const ColorBands* bands = nullptr;
    const RayGenerator* rays = nullptr;
    ImageGeometry geometry;
    Vec3d rays_world_m;         // origin of ray space
    Vec3d camera_m;             // the camera in ray space
    double start_before_m = 0;  // > 0: the camera's rays begin this far before start_at_m
    Vec3d start_at_m;           // in ray space
    int bins = 0;
    int max_depth = 1;
    float contribution_threshold = 0;
    bool sun_is_disk = false;  // shadows and highlights of a disk, by sampling; else of its middle
    bool has_glass = false;    // shadow rays must look at what they meet
    bool has_emission = false;
    bool paths_sample_lobes = false;  // a path's own directions meet lamps too: both are weighed
    float alpha_behind_diffuse = 0;   // facet lobes met behind a diffuse bounce are at least this wide
    RandomKey key;
    bool bodies_may_hide = false;                 // an object is so far away that a body can stand before it
    std::array<PixelBox, kMaxBodies> body_boxes;  // pixels that can meet a body of disks() or its air
    std::size_t body_box_count = 0;
    PixelBox sun_box;  // pixels that can meet the Sun's disk

    bool may_see_body(const PixelBox& box) const {
        for (std::size_t i = 0; i < body_box_count; ++i)
            if (box.overlaps(body_boxes[i])) return true;
        return false;
    }
    // Nothing but the background's plain body can be met in the box.
    bool sees_plain_body_only(const PixelBox& box) const {
        bool plain = false;
        for (std::size_t i = 0; i < body_box_count; ++i) {
            if (!box.overlaps(body_boxes[i])) continue;
            if (background->plain_body() != &background->disks()[i]) return false;
            plain = true;
        }
        return plain;
    }
    // Nothing but the impostor of the Earth can be met in the box.
    bool sees_earth_impostor_only(const PixelBox& box) const {
        if (!earth_impostor || box.overlaps(sun_box)) return false;
        for (std::size_t i = 1; i < body_box_count; ++i)
            if (box.overlaps(body_boxes[i])) return false;
        return box.overlaps(body_boxes[0]);
    }
    // Returns how far the camera's rays have come where they begin, about [m].
    double way_to_start_m() const {
        return start_before_m > 0 ? std::max(0.0, length(start_at_m - camera_m) - start_before_m) : 0;
    }
    // Returns where a ray of the camera begins in ray space; from_camera_m is not zero when rows have poses
    // of their own.
    Vec3f start_of(Vec3d unit_dir, Vec3d from_camera_m = {}) const {
        const Vec3d eye_m = camera_m + from_camera_m;
        if (start_before_m <= 0) return to_float(eye_m);
        // The ray begins on the plane through that point that faces it, less a margin; for what lies behind,
        // at the eye.
        const double along_m = dot(start_at_m - eye_m, unit_dir) - start_before_m;
        return to_float(eye_m + std::max(0.0, along_m) * unit_dir);
    }
};

}  // namespace hilcam
