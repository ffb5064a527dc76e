// A plug-in for an interface that this program does not have: it has to be refused before it adds anything.

#include <cstdlib>

#include "render/frame/plugin.h"

extern "C" const hilcam::PluginInfo* hilcam_plugin() {
    static const hilcam::PluginInfo info{hilcam::kPluginInterface + 1, hilcam::kPluginSizes, __VERSION__,
                                         [](hilcam::Modules&) { std::abort(); }};
    return &info;
}
