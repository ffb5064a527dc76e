#pragma once
// Says in one line what is wrong with a run's pictures so far: with the renderer's work, or with the maps it
// uses.

#include <string>

#include "render/frame/renderer.h"

namespace hilcam {

// Empty: nothing is wrong. Any thread.
std::string picture_fault(const Renderer& renderer);

}  // namespace hilcam
