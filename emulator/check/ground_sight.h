#pragma once
// The ground that a camera's boresight meets: how far it is, how large a pixel is there, how bright. The body
// is its smooth ellipsoid, without relief, at the place where its light shows it at the world's origin.

#include <optional>
#include <string>

#include "emulator/check/expected_signal.h"
#include "emulator/scenario/app_config.h"
#include "render/vocabulary/pose.h"

namespace hilcam {

struct GroundSight {
    std::string body;
    double distance_m = 0;
    double pixel_m = 0;             // across the line of sight
    double wide_m = 0, high_m = 0;  // size of the field at that distance, across the line of sight
    double off_vertical_rad = 0;    // between the line of sight and the ground's normal
    double sun_elevation_rad = 0;
    // Signal by the body's own law and mean albedo, without air, clouds and what hides the Sun. None with
    // terrain: it has a material of its own.
    std::optional<ExpectedSignal> expected;
};

// None where the boresight meets no body that is shown.
std::optional<GroundSight> ground_sight(const ScenarioConfig& scenario, const Pose& camera,
                                        const CameraSheet& sheet);

}  // namespace hilcam
