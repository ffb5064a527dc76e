#pragma once
// Says in one line what is wrong with the pictures of a run so far: with the renderer's work, and with the maps that it looks at.

#include <string>

#include "render/frame/renderer.h"

namespace hilcam {

// Empty: nothing. Any thread.
std::string picture_fault(const Renderer& renderer);

}  // namespace hilcam
