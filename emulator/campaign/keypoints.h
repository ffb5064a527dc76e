#pragma once
// Key points of objects: points in an object's axes, and where a picture shows them.

#include <string>
#include <vector>

#include "emulator/campaign/campaign_config.h"
#include "emulator/scenario/app_config.h"
#include "render/frame/frame_truth.h"

namespace hilcam {

struct KeypointSet {
    std::uint32_t object = 1;  // number, from 1
    double tolerance_m = 0.01;
    std::vector<std::string> names;
    std::vector<Vec3d> places_m;  // in the object's axes, with all joints at zero
    // The node of the joint that turns each point; an empty name, or an empty list, stands for the object
    // itself.
    std::vector<std::string> nodes{};
    // Number of that part among the renderer's objects; 0: the object itself.
    std::vector<std::uint32_t> parts{};
};

// Throws InputError for a missing column, text that is not a number, or a name that occurs twice.
std::vector<KeypointSet> load_keypoints(const std::vector<KeypointsConfig>& configs);
// Finds the scenario's joints that the points name. Throws InputError when a joint does not exist.
void find_parts(const ScenarioConfig& scenario, std::vector<KeypointSet>& sets);

struct SeenKeypoint {
    Vec2d place_px;      // inside or outside the frame; (0, 0) where the lens cannot image it
    int visibility = 0;  // COCO's number. 0: outside the frame, 1: hidden, 2: visible
};
// Needs the layer depth.
std::vector<SeenKeypoint> seen_keypoints(const KeypointSet& set, const FrameTruth& truth);

// Finds where the frame shows a point given in camera axes; false: the lens cannot image it.
bool project_to_frame(const FrameTruth& truth, Vec3d place_camera_m, Vec2d& frame_px);

}  // namespace hilcam
