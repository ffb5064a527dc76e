#pragma once
// A picture can be split into parts of its light if it is rendered in one piece.

#include <string>

namespace hilcam {

struct ScenarioConfig;

// Says in one line why pictures cannot be split; empty: they can.
std::string apart_refusal(const ScenarioConfig& scenario);

}  // namespace hilcam
