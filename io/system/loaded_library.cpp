#include "io/system/loaded_library.h"

#include <dlfcn.h>

#include "render/vocabulary/check.h"

namespace hilcam {

LoadedLibrary::LoadedLibrary(const std::string& file, const std::string& why, const std::string& package)
    : file_(file), handle_(dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (!handle_)
        throw InputError(why + " needs " + file +
                         ", which is not installed; accepted: with it (apt install " + package + ")");
}

void* LoadedLibrary::address_of(const char* name) const {
    void* const address = dlsym(handle_, name);
    if (!address) throw InputError(file_ + " has no function " + name);
    return address;
}

}  // namespace hilcam
