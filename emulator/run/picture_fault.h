#pragma once
// What is wrong with the pictures of a run so far, in one line: of the renderer's work, and of the maps that it looks at.

#include <string>

#include "render/frame/renderer.h"

namespace hilcam {

// Empty: nothing. Any thread.
std::string picture_fault(const Renderer& renderer);

}  // namespace hilcam
