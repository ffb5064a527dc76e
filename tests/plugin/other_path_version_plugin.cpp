// A path model for an interface that this program does not have: it has to be refused before it makes anything. Environment variable
// HILCAM_EMPTY_PLUGIN: one that fits, but has no model.

#include <cstdlib>

#include "render/paths/path_plugin.h"

extern "C" const hilcam::PathPluginInfo* hilcam_path_plugin() {
    static const hilcam::PathPluginInfo other{hilcam::kPathPluginInterface + 1, hilcam::kPathPluginSizes,
                                              __VERSION__, "other",
                                              []() -> hilcam::PathPlugin* { std::abort(); }};
    static const hilcam::PathPluginInfo empty{hilcam::kPathPluginInterface, hilcam::kPathPluginSizes,
                                              __VERSION__, "empty", nullptr};
    return std::getenv("HILCAM_EMPTY_PLUGIN") ? &empty : &other;
}
