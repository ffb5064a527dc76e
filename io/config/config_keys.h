#pragma once
// All keys of a configuration by their whole names, "camera.shutter.kind"; an element of a list is N:
// "objects.N.mesh". Sections and lists have keys of their own, before those below them.

#include <string>
#include <vector>

#include "render/vocabulary/config_field.h"

namespace hilcam {

// Appends an element to each list of the owner to see its keys: the owner is of no other use afterwards.
std::vector<std::string> config_keys(const Fields& root);

}  // namespace hilcam
