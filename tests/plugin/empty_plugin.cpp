// A plug-in whose entry gives nothing, and one of this program's interface that has nothing to add: environment variable
// HILCAM_EMPTY_PLUGIN chooses.

#include <cstdlib>

#include "render/frame/plugin.h"

extern "C" const hilcam::PluginInfo* hilcam_plugin() {
    static const hilcam::PluginInfo info{hilcam::kPluginInterface, hilcam::kPluginSizes, __VERSION__,
                                         nullptr};
    return std::getenv("HILCAM_EMPTY_PLUGIN") ? &info : nullptr;
}
