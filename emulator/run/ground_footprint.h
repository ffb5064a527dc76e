#pragma once
// Lists the ground in the picture that a scenario's camera takes at an instant: craters and boulders with
// their places in the frame, or slope, step and hazard for each pixel.
//
// The picture's own rays decide visibility: a thing is visible if the ray through the pixel of its centre
// ends on it, not on a hill in front of it. Places are those of mid-exposure.

#include <filesystem>
#include <memory>
#include <string>

#include "emulator/ground/ground_survey.h"
#include "emulator/scenario/app_config.h"
#include "io/truth/ground_truth.h"

namespace hilcam {

struct GroundFootprint {
    double time_offset_s = 0;
    double smallest_px = 4;  // smallest diameter in the frame; smaller things are left out
};

// Returns comma-separated values under a line of column names: craters or boulders as in survey_ground(),
// relative to the site or else to the footprint's centre, followed by the place of the thing's centre in the
// frame [px; (0.5, 0.5) is the centre of the first pixel], diameter [px], distance from the camera [m], and 1
// if visible or 0 if hidden by ground. Throws InputError where no ground is in the picture, or too much.
std::string survey_footprint(const ScenarioConfig& scenario, const GroundSurvey& survey,
                             const GroundFootprint& footprint);

// Returns the finder of craters and boulders in each frame for outputs.truth.ground_px; null: not requested.
// Throws InputError when the scenario has no ground of a body, or its maps cannot be opened.
std::shared_ptr<const GroundTruth> ground_truth_of(const ScenarioConfig& scenario);

// Writes an OpenEXR picture as large as the frame with channels slope_deg, step_m and hazard (0, 1) of the
// ground in each pixel, from heights at spacing survey.spacing_m; NaN where there is no ground. Throws
// InputError as above, DeviceError.
void write_hazards(const ScenarioConfig& scenario, const GroundSurvey& survey,
                   const GroundFootprint& footprint, const std::filesystem::path& file);

}  // namespace hilcam
