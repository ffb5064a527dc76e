#pragma once
// Models from a shared library. A plug-in is C++ built with this program's headers and compiler:
//
//     #include "render/frame/plugin.h"
//     static void add(hilcam::Modules& modules) { modules.paths.add("mine", ...); }
//     HILCAM_PLUGIN(add)
//
// A path model alone needs less of the renderer and has to be rebuilt less often: render/paths/path_plugin.h.
//
// Plug-ins exchange C++ objects, so they have to match the program exactly. Interface version, compiler, and
// the sizes of shared types are checked before any code of the plug-in runs, except the one function that
// returns them.

#include <cstdint>
#include <filesystem>
#include <span>

#include "render/paths/modules.h"

namespace hilcam {

// Raised with every change of what plug-ins see.
inline constexpr std::uint32_t kPluginInterface = 34;

struct PluginInfo {
    std::uint32_t interface_version;
    std::uint32_t shared_sizes;  // hash of the sizes of shared types
    const char* compiler;
    void (*add)(Modules& modules);
};
inline constexpr std::uint32_t kPluginSizes =
    static_cast<std::uint32_t>(sizeof(ShadingPoint) * 31 + sizeof(FrameContext) * 37 + sizeof(Material) * 41 +
                               sizeof(Tile) * 43 + sizeof(Modules) * 47);

// Loads the libraries, which stay loaded, and adds their models. Throws InputError with file and reason if
// one is missing, is not a plug-in, or does not match.
void load_plugins(std::span<const std::filesystem::path> files, Modules& modules);

}  // namespace hilcam

#define HILCAM_PLUGIN(add_function)                                                                       \
    extern "C" __attribute__((visibility("default"))) const hilcam::PluginInfo* hilcam_plugin() {         \
        static const hilcam::PluginInfo info{hilcam::kPluginInterface, hilcam::kPluginSizes, __VERSION__, \
                                             add_function};                                               \
        return &info;                                                                                     \
    }
