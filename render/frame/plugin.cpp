#include "render/frame/plugin.h"

#include <dlfcn.h>
#include <elf.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <vector>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// True when the file has all the bytes that its ELF headers tell of. The loader maps them without looking: a file that was
// cut would end the program with SIGBUS. What is no ELF file of this machine's kind is left to the loader to name.
bool is_whole(const std::filesystem::path& file, std::uintmax_t bytes) {
    std::ifstream in(file, std::ios::binary);
    Elf64_Ehdr header{};
    if (!in.read(reinterpret_cast<char*>(&header), sizeof header)) return true;
    if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 || header.e_ident[EI_CLASS] != ELFCLASS64)
        return true;
    const auto holds = [bytes](std::uint64_t from, std::uint64_t size) {
        return from <= bytes && size <= bytes - from;
    };
    if (!holds(header.e_shoff, std::uint64_t{header.e_shnum} * header.e_shentsize) ||
        !holds(header.e_phoff, std::uint64_t{header.e_phnum} * sizeof(Elf64_Phdr)))
        return false;
    std::vector<Elf64_Phdr> segments(header.e_phnum);
    in.seekg(static_cast<std::streamoff>(header.e_phoff));
    in.read(reinterpret_cast<char*>(segments.data()),
            static_cast<std::streamsize>(segments.size() * sizeof(Elf64_Phdr)));
    return in && std::all_of(segments.begin(), segments.end(),
                             [&](const Elf64_Phdr& s) { return holds(s.p_offset, s.p_filesz); });
}

void load_plugin(const std::filesystem::path& file, Modules& modules) {
    const auto refuse = [&](const std::string& why) {
        throw InputError("plug-in " + file.string() + ": " + why);
    };
    std::error_code error;
    // dlopen() would wait for a pipe.
    if (!std::filesystem::is_regular_file(file, error)) refuse("there is no such file");
    // Of a bare name dlopen() searches the system's folders, which may hold another file of that name.
    const std::filesystem::path here = std::filesystem::absolute(file, error);
    const std::uintmax_t bytes = error ? 0 : std::filesystem::file_size(here, error);
    if (error) refuse("cannot be read: " + error.message());
    if (!is_whole(here, bytes))
        refuse("found " + std::to_string(bytes) + " bytes, fewer than its headers tell of: it was cut; " +
               "accepted: a whole shared library");
    // Never closed: models made by it may live as long as the program.
    void* library = dlopen(here.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) refuse(std::string("cannot be loaded: ") + dlerror());
    const auto entry = reinterpret_cast<const PluginInfo* (*)()>(dlsym(library, "hilcam_plugin"));
    if (!entry) refuse("is no hilcam plug-in: it has no function hilcam_plugin()");
    const PluginInfo* info = entry();
    if (!info)
        refuse("is no hilcam plug-in: its hilcam_plugin() gives nothing; accepted: HILCAM_PLUGIN(add)");
    if (info->interface_version != kPluginInterface)
        refuse("is for plug-in interface " + std::to_string(info->interface_version) + "; this program has " +
               std::to_string(kPluginInterface) + "; build it again with this program's headers");
    const std::string compiler = info->compiler ? info->compiler : "(none)";
    if (info->shared_sizes != kPluginSizes || compiler != __VERSION__)
        refuse("was built by compiler " + compiler +
               " with other headers or options than this "
               "program (" +
               __VERSION__ + "); build it again beside it");
    if (!info->add)
        refuse("is no hilcam plug-in: it has no function that adds models; accepted: HILCAM_PLUGIN(add)");
    info->add(modules);
}

}  // namespace

void load_plugins(std::span<const std::filesystem::path> files, Modules& modules) {
    for (const std::filesystem::path& file : files) load_plugin(file, modules);
}

}  // namespace hilcam
