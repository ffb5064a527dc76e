#pragma once
// Finds probable mistakes in a scenario that has no errors: one line each, with the place of the key. One
// list serves all commands: `hilcam check` prints all of it, `render` what concerns a picture, `run` what
// concerns a run.

#include <string>
#include <vector>

#include "emulator/check/check_report.h"
#include "emulator/ground/map_report.h"
#include "emulator/scenario/scene_loader.h"

namespace hilcam {

enum class VerdictOn { kAll, kPicture, kRun };

// A camera with its loaded scene. The renderer is placed at the instant to look at
// (Renderer::place_for_truth). scenario: as that camera has it.
struct LoadedView {
    const ScenarioConfig& scenario;
    const Renderer& renderer;
    const std::vector<LoadedObject>& objects;
};

// Judges before anything is loaded. keeps_frames: the run records its frames. Throws InputError when the
// scenario's motions cannot be built.
std::vector<std::string> early_verdict(const ScenarioConfig& bench, VerdictOn on, bool keeps_frames = false);
// Judges materials and meshes of loaded objects.
std::vector<std::string> verdict_on_objects(const LoadedView& view, VerdictOn on);
// Reports how the maps of the ground and of flattened bodies were understood. Throws InputError.
MapReport report_scenario_maps(const ScenarioConfig& scenario);
// Judges what the camera sees at that instant. camera: from report_view().
std::vector<std::string> verdict_on_view(const ScenarioConfig& scenario, const CameraReport& camera);
// Collects what a camera is judged by: its data sheet and what it sees. number: from 1.
CameraReport report_view(const LoadedView& view, std::size_t number, const Pose& first_camera);

}  // namespace hilcam
