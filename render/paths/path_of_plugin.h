#pragma once
// Runs the path model of a plug-in (path_plugin.h) as one of the renderer's.

#include <memory>

#include "render/paths/path_plugin.h"
#include "render/shading/path_model.h"

namespace hilcam {

// Owner thread; the returned model follows the rules of PathModel.
std::unique_ptr<PathModel> make_path_of_plugin(std::unique_ptr<PathPlugin> model);

}  // namespace hilcam
