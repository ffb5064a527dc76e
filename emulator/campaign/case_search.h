#pragma once
// Draws a case until it is what the campaign asks for.

#include "emulator/campaign/case_camera.h"
#include "emulator/campaign/case_plan.h"

namespace hilcam {

// Draws the case and makes it the camera's. InputError: a value that the scenario refuses, or that none of the
// tries was fit, with what was tried and why it was not.
CasePlan find_case(const CampaignConfig& campaign, const CaseDraw& draw, std::uint64_t number,
                   CaseCamera& camera);

// Returns the share of a thing's visible pixels that face the Sun, times the share of the Sun that bodies leave
// at it. Shadows that it casts on itself, or others on it, are not among that. Needs the layers object and
// normal.
double lit_share_of(const FrameTruth& truth, const SeenThing& thing);

}  // namespace hilcam
