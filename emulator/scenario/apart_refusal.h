#pragma once
// Pictures can be taken apart into the parts of their light where they are of one rendering in which each pixel is sampled as often as
// every other.

#include <span>
#include <string>

#include "render/frame/render_quality.h"

namespace hilcam {

struct ScenarioConfig;

// Says in one line why pictures cannot be taken apart; empty: they can. levels: the qualities that pictures may have, the configured one
// first.
std::string apart_refusal(const ScenarioConfig& scenario, std::span<const RenderQuality> levels);

}  // namespace hilcam
