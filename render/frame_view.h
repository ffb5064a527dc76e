#pragma once
// What the rays of one frame share: scene, camera, background, quality.

#include <vector>

#include "render/background.h"
#include "render/color_bands.h"
#include "render/embree_scene.h"
#include "render/pixel_box.h"
#include "render/random.h"
#include "render/ray_generator.h"
#include "render/screen_mask.h"
#include "render/surface.h"

namespace hilcam {

// What one frame's tiles share. Constant while they are traced.
struct FrameView {
    const EmbreeScene* scene = nullptr;
    const std::vector<ObjectSurfaces>* objects = nullptr;
    std::vector<Mat3f> world_from_body;       // per object
    const ScreenMask* object_mask = nullptr;  // pixels that can meet an object
    const Background* background = nullptr;
    const ColorBands* bands = nullptr;
    ImageGeometry geometry;
    Mat3d world_from_camera;
    // The direction through the corner of padded pixel (0, 0), and what a pixel to the right or down adds.
    Vec3d corner_world_dir, right_world_dir, down_world_dir;
    int bins = 0;
    int samples_per_axis = 1;
    int max_depth = 1;
    float contribution_threshold = 0;
    float samples() const { return static_cast<float>(samples_per_axis * samples_per_axis); }
    RandomKey key;
    bool earth_may_hide = false;  // an object is so far away that the Earth can stand before it
    PixelBox earth_box;           // pixels that can meet the Earth
    PixelBox sun_box;             // pixels that can meet the Sun's disk
};

}  // namespace hilcam
