#include "render/frame/plugin.h"

#include <dlfcn.h>

#include <cstring>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

void load_plugin(const std::filesystem::path& file, Modules& modules) {
    const auto refuse = [&](const std::string& why) {
        throw InputError("plug-in " + file.string() + ": " + why);
    };
    // dlopen() would wait for a pipe.
    if (!std::filesystem::is_regular_file(file)) refuse("there is no such file");
    // Never closed: models made by it may live as long as the program.
    void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) refuse(std::string("cannot be loaded: ") + dlerror());
    const auto entry = reinterpret_cast<const PluginInfo* (*)()>(dlsym(library, "hilcam_plugin"));
    if (!entry) refuse("is no hilcam plug-in: it has no function hilcam_plugin()");
    const PluginInfo* info = entry();
    if (info->interface_version != kPluginInterface)
        refuse("is for plug-in interface " + std::to_string(info->interface_version) + "; this program has " +
               std::to_string(kPluginInterface) + "; build it again with this program's headers");
    if (info->shared_sizes != kPluginSizes || std::strcmp(info->compiler, __VERSION__) != 0)
        refuse(std::string("was built by compiler ") + info->compiler +
               " with other headers or options than this "
               "program (" +
               __VERSION__ + "); build it again beside it");
    info->add(modules);
}

}  // namespace

void load_plugins(std::span<const std::filesystem::path> files, Modules& modules) {
    for (const std::filesystem::path& file : files) load_plugin(file, modules);
}

}  // namespace hilcam
