#pragma once
// The camera's stand about its target, drawn: direction, range, place in the picture, roll, exposure.
//
// The camera stands still against the target. Frames: world axes as the scenario's; places in the frame are px
// of it (docs/truth.md).

#include "emulator/campaign/case_camera.h"
#include "emulator/campaign/case_plan.h"

namespace hilcam {

// Draws the view of a case whose world the camera has taken, and adds what it means to the plan: camera_pose,
// exposure, columns. Throws InputError where there is no such view: a range within the target, no Sun.
void draw_view(const ViewConfig& view, const CaseDraw& draw, std::uint32_t attempt, CaseCamera& camera,
               CasePlan& plan);

// The columns that it adds, in their order.
std::vector<std::string> view_columns(const ViewConfig& view);

// A record for what the camera's frames show: with a ray for each pixel where visibility or a layer is asked
// for.
FrameTruth truth_record(const CaseCamera& camera, const TruthRequest& request);

// Returns the range [m] at which a sphere of that radius appears so large [px] on the boresight of a lens
// without distortion: half its diameter is tan(asin(r / d)) focal lengths.
double range_of_size_m(double radius_m, double size_px, double focal_length_px);

}  // namespace hilcam
