#pragma once
// Models from a shared library. A plug-in is C++ built with this program's headers and compiler:
//
//     #include "render/frame/plugin.h"
//     static void add(hilcam::Modules& modules) { modules.paths.add("mine", ...); }
//     HILCAM_PLUGIN(add)
//
// A path model needs less of the renderer, and is rebuilt less often: render/paths/path_plugin.h.
//
// What it passes are C++ objects, so it has to match the program exactly: interface version, compiler and the
// sizes of what is shared are checked before any of its code runs but the one function that gives them.

#include <cstdint>
#include <filesystem>
#include <span>

#include "render/paths/modules.h"

namespace hilcam {

// Raised with every change of what plug-ins see.
inline constexpr std::uint32_t kPluginInterface = 33;

struct PluginInfo {
    std::uint32_t interface_version;
    std::uint32_t shared_sizes;  // sizes of the types on which both sides must agree
    const char* compiler;
    void (*add)(Modules& modules);
};
inline constexpr std::uint32_t kPluginSizes =
    static_cast<std::uint32_t>(sizeof(ShadingPoint) * 31 + sizeof(FrameContext) * 37 + sizeof(Material) * 41 +
                               sizeof(Tile) * 43 + sizeof(Modules) * 47);

// Loads the libraries and adds their models; they stay loaded. Throws InputError with file and reason when
// one is missing, no plug-in, or does not fit.
void load_plugins(std::span<const std::filesystem::path> files, Modules& modules);

}  // namespace hilcam

#define HILCAM_PLUGIN(add_function)                                                                       \
    extern "C" __attribute__((visibility("default"))) const hilcam::PluginInfo* hilcam_plugin() {         \
        static const hilcam::PluginInfo info{hilcam::kPluginInterface, hilcam::kPluginSizes, __VERSION__, \
                                             add_function};                                               \
        return &info;                                                                                     \
    }
