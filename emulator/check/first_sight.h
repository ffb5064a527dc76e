#pragma once
// Finds what a camera sees at the scenario's first instant, by a ray through every pixel and not by a
// picture: where objects are, how they are lit, what hides them.

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
    double off_boresight_rad = 0;  // angle of its origin
    // Angular radius of the sphere about its origin that holds it; pi: the camera is in that.
    double angular_radius_rad = 0;
    double phase_rad = 0;  // NaN: the camera is at its origin
    double sunlit = 1;
    double silhouette_px = 0;     // area that it would cover alone
    double picture_share = 0;     // share of the frame's pixels that show it
    double visible_fraction = 0;  // share of its silhouette
    bool holds_camera = false;    // the camera stands within the box of its mesh, and does not ride on it
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
    // Position in the local axes of the scenario's site, if it has one on the origin's body.
    std::optional<Vec3d> from_site_m;
    std::string site_body;
    // Position of the camera in the first one's axes, and its rotation against that.
    Vec3d from_first_m;
    double turned_rad = 0;
};

// The scene is loaded, and the renderer has placed the instant that is looked at (Renderer::place_for_truth).
FirstSight first_sight(const ScenarioConfig& scenario, const Renderer& renderer,
                       const std::vector<LoadedObject>& objects, const CameraSheet& sheet,
                       const Pose& first_camera);

}  // namespace hilcam
