#pragma once
// Key points of objects: places in an object's axes, and where a picture shows them.

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
    std::vector<Vec3d> places_m;  // in the object's axes, its parts not turned
    // The part that each point turns with: the node of a joint; empty, or no list: the object itself.
    std::vector<std::string> nodes{};
    std::vector<std::uint32_t> parts{};  // its number among the renderer's objects; 0: the object itself
};

// Throw InputError: no such column, a number that is none, a name that is given twice.
std::vector<KeypointSet> load_keypoints(const std::vector<KeypointsConfig>& configs);
// Finds the parts that points name among a scenario's joints. Throws InputError: no such joint.
void find_parts(const ScenarioConfig& scenario, std::vector<KeypointSet>& sets);

struct SeenKeypoint {
    Vec2d place_px;      // in the frame, or beside it; 0, 0 where the lens has no place for it
    int visibility = 0;  // COCO's number. 0: not in the frame, 1: hidden by something, 2: visible
};
// Needs the layer depth.
std::vector<SeenKeypoint> seen_keypoints(const KeypointSet& set, const FrameTruth& truth);

// Returns where the frame shows a place in camera axes; false: nowhere.
bool project_to_frame(const FrameTruth& truth, Vec3d place_camera_m, Vec2d& frame_px);

}  // namespace hilcam
