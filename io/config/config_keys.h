#pragma once
// All keys of a configuration by their full names, "camera.shutter.kind". N stands for an element of a list:
// "objects.N.mesh". Sections and lists have keys of their own, before those below them.

#include <string>
#include <vector>

#include "render/vocabulary/config_field.h"

namespace hilcam {

// Returns the keys. Appends an element to each list of the owner to find them, so the owner must not be used
// afterwards.
std::vector<std::string> config_keys(const Fields& root);

}  // namespace hilcam
