#pragma once
// The verdict about a scenario in which nothing is wrong: what is probably not meant, a line each, with the place of the
// key. It is one list: `hilcam check` prints all of it, `render` what concerns a picture, `run` what concerns a run.

#include <string>
#include <vector>

#include "emulator/check/check_report.h"
#include "emulator/ground/map_report.h"
#include "emulator/scenario/scene_loader.h"

namespace hilcam {

enum class VerdictOn { kAll, kPicture, kRun };

// A camera with its scene, as loaded; the renderer has placed the instant that is looked at (Renderer::place_for_truth).
// scenario: as that camera has it.
struct LoadedView {
    const ScenarioConfig& scenario;
    const Renderer& renderer;
    const std::vector<LoadedObject>& objects;
};

// Judges before anything is loaded. keeps_frames: a run's frames are recorded. Throws InputError where the scenario's motions
// cannot be had.
std::vector<std::string> early_verdict(const ScenarioConfig& bench, VerdictOn on, bool keeps_frames = false);
// Once the objects are loaded: their materials and meshes.
std::vector<std::string> verdict_on_objects(const LoadedView& view, VerdictOn on);
// Tells how the maps of the ground and of flattened bodies were understood. Throws InputError.
MapReport report_scenario_maps(const ScenarioConfig& scenario);
// Judges what the camera sees at that instant. camera: from report_view().
std::vector<std::string> verdict_on_view(const ScenarioConfig& scenario, const CameraReport& camera);
// Finds what there is to judge a camera by: its sheet and what it sees. number: from 1.
CameraReport report_view(const LoadedView& view, std::size_t number, const Pose& first_camera);

}  // namespace hilcam
