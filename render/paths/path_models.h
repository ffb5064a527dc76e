#pragma once
// The program's own path models (path_model.h).

#include <memory>

#include "render/shading/path_model.h"

namespace hilcam {

std::unique_ptr<PathModel> make_direct_paths();
std::unique_ptr<PathModel> make_cached_paths();
std::unique_ptr<PathModel> make_traced_paths();

}  // namespace hilcam
