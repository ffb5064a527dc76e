#pragma once
// Draws the camera's view of its target: direction, range, place in the picture, roll, exposure.
//
// The camera does not move relative to the target. Axes are the scenario's world axes; places in the picture
// are in px of the frame (docs/truth.md).

#include "emulator/campaign/case_camera.h"
#include "emulator/campaign/case_plan.h"

namespace hilcam {

// Draws the view of a case after the camera has taken over its world, and adds the resulting values to the
// plan: camera_pose, exposure, columns. Throws InputError for an impossible view: a range inside the target,
// or no Sun.
void draw_view(const ViewConfig& view, const CaseDraw& draw, std::uint32_t attempt, CaseCamera& camera,
               CasePlan& plan);

// Returns the columns that draw_view() adds, in order.
std::vector<std::string> view_columns(const ViewConfig& view);

// Returns a record of truth for the camera's frames, with a ray for each pixel if visibility or a layer is
// requested.
FrameTruth truth_record(const CaseCamera& camera, const TruthRequest& request);

// Returns the range [m] at which a sphere appears size_px wide on the boresight of a lens without distortion:
// half its diameter in px is tan(asin(r / d)) focal lengths.
double range_of_size_m(double radius_m, double size_px, double focal_length_px);

}  // namespace hilcam
