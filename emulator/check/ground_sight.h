#pragma once
// The ground where a camera's boresight meets a body: its distance, the size of a pixel there, its
// brightness. The body is its smooth ellipsoid, without relief, at its light-time corrected place as seen
// from the world's origin.

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
    double off_vertical_rad = 0;    // angle between the line of sight and the ground's normal
    double sun_elevation_rad = 0;
    // Signal from the body's own law and mean albedo. Air, clouds, and anything that covers the Sun are
    // ignored. Empty with terrain, which has its own material.
    std::optional<ExpectedSignal> expected;
};

// Returns nothing when the boresight meets no body that is shown.
std::optional<GroundSight> ground_sight(const ScenarioConfig& scenario, const Pose& camera,
                                        const CameraSheet& sheet);

}  // namespace hilcam
