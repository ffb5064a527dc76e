#pragma once
// This tells what of a scenario's ground is in the picture that its camera takes at an instant: the craters and boulders with their places in
// the frame, and slopes, steps and hazards for each pixel.
//
// The picture's own rays say what is seen: a thing counts as visible where the ray through its middle's pixel ends at it, not at
// a hill before it. Places are of mid-exposure.

#include <filesystem>
#include <memory>
#include <string>

#include "emulator/ground/ground_survey.h"
#include "emulator/scenario/app_config.h"
#include "io/truth/ground_truth.h"

namespace hilcam {

struct GroundFootprint {
    double time_offset_s = 0;
    double smallest_px = 4;  // diameter in the frame; smaller things are left out
};

// Returns comma-separated values with a line of names: craters or boulders as survey_ground() has them about the site or, without one,
// the footprint's middle, then the middle's place in the frame [px; (0.5, 0.5) is the first pixel's middle], diameter [px],
// distance from the camera [m], and whether it is visible (1) or behind other ground (0). Throws InputError where no ground is in
// the picture, or too much.
std::string survey_footprint(const ScenarioConfig& scenario, const GroundSurvey& survey,
                             const GroundFootprint& footprint);

// Returns who finds the craters and boulders of each frame for outputs.truth.ground_px; null: nobody asked. Throws InputError where
// the scenario has no ground of a body, or its maps cannot be opened.
std::shared_ptr<const GroundTruth> ground_truth_of(const ScenarioConfig& scenario);

// Writes an OpenEXR picture of the frame's size with the channels slope_deg, step_m and hazard (0, 1) of the ground that each pixel
// shows, by heights at survey.spacing_m about it; NaN where there is none. Throws InputError as above, DeviceError.
void write_hazards(const ScenarioConfig& scenario, const GroundSurvey& survey,
                   const GroundFootprint& footprint, const std::filesystem::path& file);

}  // namespace hilcam
