#pragma once
// Finds what a camera sees at the scenario's first instant, with one ray for each pixel and no rendering:
// where objects are, how they are lit, and what hides them.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "emulator/check/expected_signal.h"
#include "emulator/check/ground_sight.h"
#include "emulator/scenario/scene_loader.h"
#include "render/vocabulary/attitude.h"

namespace hilcam {

struct SeenObject {
    LoadedObject loaded;
    enum class Place { kVisible, kHidden, kOutside, kBehind } place = Place::kVisible;
    double distance_m = 0;
    double off_boresight_rad = 0;  // angle to the object's origin
    // Angular radius of the object's bounding sphere about its origin; pi: the camera is inside it.
    double angular_radius_rad = 0;
    double phase_rad = 0;  // NaN: the camera is at the object's origin
    double sunlit = 1;
    double silhouette_px = 0;     // area if nothing hid it
    double picture_share = 0;     // share of the frame's pixels that show the object
    double visible_fraction = 0;  // visible share of the silhouette
    bool holds_camera = false;  // true: the camera is inside the mesh's box, and does not ride on the object
    ExpectedSignal expected;
};

struct FirstSight {
    std::vector<SeenObject> objects;
    Vec3d sun_camera_dir;
    double sun_off_boresight_rad = 0, sun_distance_au = 0;
    bool shows_sun = false, shows_body = false;
    std::optional<GroundSight> ground;
    std::optional<double> height_above_ground_m;  // over terrain
    Pose camera;
    RaDecRoll pointing;
    // Position in the local axes of the scenario's site, if the origin's body has one.
    std::optional<Vec3d> from_site_m;
    std::string site_body;
    // Position and rotation relative to the first camera, in its axes.
    Vec3d from_first_m;
    double turned_rad = 0;
};

// The scene must be loaded, and the renderer placed at the instant to look at (Renderer::place_for_truth).
FirstSight first_sight(const ScenarioConfig& scenario, const Renderer& renderer,
                       const std::vector<LoadedObject>& objects, const CameraSheet& sheet,
                       const Pose& first_camera);

}  // namespace hilcam
