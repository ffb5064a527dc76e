#pragma once
// The truth of a frame: what it shows, as the renderer had it: poses, directions, places in the frame, and
// what each pixel's middle ray meets. For those who train and score image processing (docs/truth.md).
//
// All of it is of the frame's own instant, mid-exposure, and told by what the picture is made with: the ray
// generator, the placed scene, the background, the stars. Not in it: what blur, noise and faults do to the
// picture afterwards, and light that comes by reflection.
//
// Camera axes are those of mid-exposure, +x right, +y down, +z along the boresight. Places in the frame are
// in px of the published frame, binned and mirrored as it is; the centre of pixel (0, 0) is at (0.5, 0.5).

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "render/frame/frame_raster.h"
#include "render/sky/bodies.h"
#include "render/vocabulary/image.h"
#include "render/vocabulary/image_geometry.h"
#include "render/vocabulary/pixel_box.h"
#include "render/vocabulary/pose.h"
#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/time.h"

namespace hilcam {

struct Star;

// The parts of the truth that somebody has asked for.
struct TruthRequest {
    bool visibility = true;  // pixels, boxes and shares of each thing: a ray through every pixel
    bool stars = true;
    double faintest_magnitude = 30;
    // Layers, a value for each pixel.
    bool object = false, range = false, depth = false, normal = false, position = false, part = false;
    // FrameTruth::silhouettes, with visibility; they are allocated for each frame, so this is not for the loop.
    bool silhouettes = false;
    // The thing of which each object of the renderer is a part; empty: each object is a thing of its own. The
    // first of a thing's objects gives its pose. Things are numbered in the order of their first objects.
    std::vector<std::uint32_t> thing_of_object;

    bool layers() const { return object || range || depth || normal || position || part; }
    bool rays() const { return visibility || layers(); }
};

// Numbers of things in the object layer: 0 is sky, objects have 1, 2, 3, ... as commands number them, bodies
// a million and their NAIF number (NAIF Integer ID codes, SPICE toolkit): 1000010 is the Sun.
inline constexpr std::uint32_t kSkyId = 0;
inline constexpr std::uint32_t kFirstBodyId = 1'000'000;
inline constexpr std::uint32_t kSunId = kFirstBodyId + 10;
inline std::uint32_t truth_id(BodyId body) {
    return body == BodyId::kMoon
               ? kFirstBodyId + 301
               : kFirstBodyId + 99 +
                     100 * (1 + static_cast<std::uint32_t>(body) - (body > BodyId::kMoon ? 1u : 0u));
}

// An object with all its parts, or a body.
struct SeenThing {
    static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

    std::uint32_t id = kSkyId;
    bool is_body = false;
    Pose world;               // pose of its own axes; the Sun's and a body's place is the apparent one
    Vec3d position_camera_m;  // position of its origin
    Quat camera_from_thing;
    double distance_m = 0;     // distance of its origin
    bool has_center = false;   // its origin is before the camera, where the lens has a place for it
    Vec2d center_px;           // where its origin is in the frame, or beside it
    double phase_rad = 0;      // Sun - origin - camera
    double sunlit = kUnknown;  // share of the Sun's disk that bodies leave at its origin; objects only
    double radius_m = 0;  // radius of the sphere about its origin that holds it; a body's equatorial radius
    double polar_radius_m = 0;  // bodies only

    // This is filled with TruthRequest::visibility. A pixel is visible when the ray through its middle meets
    // the thing first; the silhouette is what the thing alone would cover, in the frame and beside it, up to
    // one frame's width and height on each side. Of a thing below kSmall_px both are measured on 64 x 64 rays
    // over its own bounds instead, so that it need not meet a pixel's middle.
    static constexpr int kSmall_px = 32;
    std::uint64_t visible_px = 0;        // pixels of the object layer
    Vec2d visible_center_px;             // mean of their middles
    PixelBox visible_box_px;             // px of the frame; empty when nothing is visible
    double silhouette_px = 0;            // area
    PixelBox silhouette_box_px;          // may reach beyond the frame
    bool silhouette_cut = false;         // there is more of it than a frame's size away
    double visible_fraction = kUnknown;  // visible area over the silhouette's
};

// The pixels that a whole object covers by the rays through their middles alone, large or small, in the frame and
// as far beside it as SeenThing has it; for labels. Beside the frame a ray may stand for a square of several.
struct PixelSilhouette {
    std::uint32_t thing = kSkyId;  // id of the object
    std::uint64_t px = 0;          // pixels that it would cover if it were alone
    PixelBox box_px;               // px of the frame; may reach beyond it
    // The frame's pixels that it covers behind other things, by row * width + column, rising. With the object's
    // own pixels of the object layer they are its silhouette in the frame.
    std::vector<std::uint32_t> hidden_px;
};

// A part of an object that turns: where it is now.
struct SeenPart {
    std::uint32_t thing = kSkyId;  // id of what it is part of
    std::uint32_t object = 0;      // its number among the renderer's objects, from 0
    Vec3d position_camera_m;       // position of its origin, which is the object's while it is not turned
    Quat camera_from_part;
};

struct SeenStar {
    std::uint32_t row = 0;  // row among the catalogue's stars, from 0
    std::uint32_t hip = 0;  // Hipparcos number; 0: none
    std::uint32_t hd = 0;   // Henry Draper number; 0: none
    Vec2d position_px;      // in the frame
    Vec2d image_px;         // in the radiance image, without its guard band
    float magnitude_v = 0;
    Spectrum irradiance_w_m2_um;  // at the aperture, as drawn
};

using IdImage = Image<std::uint32_t, struct IdQuantity>;
using LengthImage = Image<float, struct LengthQuantity>;        // [m]
using DirectionImage = Image<float, struct DirectionQuantity>;  // three planes: x, y, z

// Sizes are 0 where a layer was not asked for. Sky: id 0, infinite lengths, zero normals. Black columns and
// rows are as sky.
struct TruthLayers {
    IdImage object;          // is filled for visibility alone, too
    IdImage part;            // 1 + number of the renderer's object, from 0; 0: none. Not written to files
    LengthImage range_m;     // along the ray, from the camera's place at that row's instant
    LengthImage depth_m;     // along the boresight of mid-exposure: z in camera axes
    LengthImage position_m;  // in camera axes; three planes
    DirectionImage normal;   // unit, towards the camera, camera axes; the one that objects are shaded with
};

struct FrameTruth {
    // --- before the frame
    TruthRequest request;
    FrameRaster raster;

    // --- told by the renderer
    TimeTai time;               // mid-exposure
    Pose camera;                // pointing jitter included
    Vec3d camera_velocity_m_s;  // in the world
    Vec3d camera_rate_rad_s;    // about the camera's axes
    ImageGeometry geometry;     // geometry of the radiance image
    Vec3d sun_world_dir;        // from the camera
    Vec3d sun_camera_dir;       // the same in camera axes
    double sun_distance_m = 0;  // from the camera
    // The camera's, over the map of the terrain; none: there is no terrain below it.
    std::optional<double> height_above_ground_m;
    std::vector<SeenThing> things;  // objects by number, then the Sun, then bodies
    std::vector<SeenPart> parts;
    std::vector<SeenStar> stars;       // that are drawn in the frame, in the catalogue's order
    std::uint64_t stars_left_out = 0;  // for which there was no room
    TruthLayers layers;
    std::vector<PixelSilhouette> silhouettes;  // those of the objects, without terrain
    double took_ms = 0;

    // Scratch: where objects that are drawn as points can be met, and the stars of the field.
    std::vector<PixelBox> point_boxes;
    struct StarInField {
        const Star* star;
        Vec3d dir;
    };
    std::vector<StarInField> star_field;
};

}  // namespace hilcam
