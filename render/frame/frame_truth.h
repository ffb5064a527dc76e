#pragma once
// The truth of a frame, as the renderer knows it: poses, directions, places in the frame, and what the ray
// through each pixel's middle meets. For training and scoring image processing (docs/truth.md).
//
// Everything holds at the frame's own instant, mid-exposure, and comes from what makes the picture: the ray
// generator, the placed scene, the background, the stars. It does not contain what blur, noise and faults do
// to the picture later, nor light that arrives by reflection.
//
// Camera axes are those of mid-exposure: +x right, +y down, +z along the boresight. Places in the frame are
// in px of the published frame, after binning and mirroring; the centre of pixel (0, 0) is at (0.5, 0.5).

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

// The parts of the truth that are asked for.
struct TruthRequest {
    bool visibility = true;  // pixels, boxes and shares of each thing, by a ray through every pixel
    bool stars = true;
    double faintest_magnitude = 30;
    // Layers: a value for each pixel.
    bool object = false, range = false, depth = false, normal = false, position = false, part = false;
    // Asks for FrameTruth::silhouettes; needs visibility. They are allocated for each frame, so this is not
    // for the loop.
    bool silhouettes = false;
    // For each object of the renderer, the thing that it is part of; empty: each object is its own thing. The
    // first object of a thing gives its pose. Things are numbered in the order of their first objects.
    std::vector<std::uint32_t> thing_of_object;

    bool layers() const { return object || range || depth || normal || position || part; }
    bool rays() const { return visibility || layers(); }
};

// Ids in the object layer: 0 is sky, objects have 1, 2, 3, ... as in commands, and a body has a million plus
// its NAIF number (NAIF Integer ID codes, SPICE toolkit): 1000010 is the Sun.
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
    Pose world;               // pose of its axes; for the Sun and bodies, the apparent position
    Vec3d position_camera_m;  // position of its origin
    Quat camera_from_thing;
    double distance_m = 0;    // to its origin
    bool has_center = false;  // its origin is in front of the camera and inside the lens's field
    Vec2d center_px;          // its origin in the frame, or outside it
    double phase_rad = 0;     // angle Sun - origin - camera
    // Share of the Sun's disk not covered by bodies, seen from its origin; objects only.
    double sunlit = kUnknown;
    double radius_m = 0;        // sphere about its origin that holds it; a body's equatorial radius
    double polar_radius_m = 0;  // bodies only

    // The following needs TruthRequest::visibility. A pixel is visible if the ray through its middle meets
    // the thing first. The silhouette is what the thing would cover if it were alone, in the frame and up to
    // one frame's width and height beside it. For a thing smaller than kSmall_px both are measured by 64 x 64
    // rays over its own bounds, so that it counts even if it covers no pixel's middle.
    static constexpr int kSmall_px = 32;
    std::uint64_t visible_px = 0;        // its pixels in the object layer
    Vec2d visible_center_px;             // mean of their middles
    PixelBox visible_box_px;             // px of the frame; empty if nothing is visible
    double silhouette_px = 0;            // area
    PixelBox silhouette_box_px;          // may extend beyond the frame
    bool silhouette_cut = false;         // it continues farther than one frame's size away
    double visible_fraction = kUnknown;  // visible area over silhouette area
};

// The pixels that a whole object, of any size, covers, by the rays through their middles: in the frame and as
// far beside it as SeenThing has it. For labels. Beside the frame one ray may represent a square of several
// pixels.
struct PixelSilhouette {
    std::uint32_t thing = kSkyId;  // id of the object
    std::uint64_t px = 0;          // pixels that it would cover if it were alone
    PixelBox box_px;               // px of the frame; may extend beyond it
    // Pixels of the frame that it covers behind other things, as row * width + column, in rising order.
    // Together with the object's own pixels of the object layer they are its silhouette in the frame.
    std::vector<std::uint32_t> hidden_px;
};

// The present place of an object's part that turns.
struct SeenPart {
    std::uint32_t thing = kSkyId;  // id of the thing that it is part of
    std::uint32_t object = 0;      // its number among the renderer's objects, from 0
    Vec3d position_camera_m;  // position of its origin; equal to the object's when the part is not turned
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

// A layer that was not asked for has size 0. Sky has id 0, infinite lengths and zero normals; so have black
// columns and rows.
struct TruthLayers {
    IdImage object;          // is also filled if only visibility is asked for
    IdImage part;            // 1 + number of the renderer's object; 0: none. Not written to files
    LengthImage range_m;     // along the ray, from the camera's position when its row is exposed
    LengthImage depth_m;     // along the boresight of mid-exposure: z in camera axes
    LengthImage position_m;  // in camera axes; three planes
    DirectionImage normal;   // shading normal, unit, towards the camera, in camera axes
};

struct FrameTruth {
    // --- set before the frame
    TruthRequest request;
    FrameRaster raster;

    // --- filled by the renderer
    TimeTai time;               // mid-exposure
    Pose camera;                // pointing jitter included
    Vec3d camera_velocity_m_s;  // in the world
    Vec3d camera_rate_rad_s;    // about the camera's axes
    ImageGeometry geometry;     // geometry of the radiance image
    Vec3d sun_world_dir;        // from the camera
    Vec3d sun_camera_dir;       // the same in camera axes
    double sun_distance_m = 0;  // from the camera
    // The camera's height over the terrain's map; nothing if no terrain is below it.
    std::optional<double> height_above_ground_m;
    std::vector<SeenThing> things;  // objects by number, the Sun, bodies
    std::vector<SeenPart> parts;
    std::vector<SeenStar> stars;       // those drawn in the frame, in the catalogue's order
    std::uint64_t stars_left_out = 0;  // number of stars for which there was no room
    TruthLayers layers;
    std::vector<PixelSilhouette> silhouettes;  // those of the objects, without terrain
    double took_ms = 0;

    // Scratch memory: the boxes of objects that are drawn as points, and the stars in the field.
    std::vector<PixelBox> point_boxes;
    struct StarInField {
        const Star* star;
        Vec3d dir;
    };
    std::vector<StarInField> star_field;
};

}  // namespace hilcam
