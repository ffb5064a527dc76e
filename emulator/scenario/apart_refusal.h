#pragma once
// Pictures can be taken apart into the parts of their light where they are of one rendering.

#include <string>

namespace hilcam {

struct ScenarioConfig;

// Says in one line why pictures cannot be taken apart; empty: they can.
std::string apart_refusal(const ScenarioConfig& scenario);

}  // namespace hilcam
