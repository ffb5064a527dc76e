#pragma once
// Draws a case again and again until it meets the campaign's conditions.

#include "emulator/campaign/case_camera.h"
#include "emulator/campaign/case_plan.h"

namespace hilcam {

// Draws the case and lets the camera take it over. Throws InputError for a value that the scenario refuses,
// or when no attempt met the conditions; the message says what was tried and why it was rejected.
CasePlan find_case(const CampaignConfig& campaign, const CaseDraw& draw, std::uint64_t number,
                   CaseCamera& camera);

// Returns the share of a thing's visible pixels that face the Sun, times the visible share of the Sun's disk
// where bodies cover part of it. Shadows from objects, including its own, are not counted. Needs the layers
// object and normal.
double lit_share_of(const FrameTruth& truth, const SeenThing& thing);

}  // namespace hilcam
