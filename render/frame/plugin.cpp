#include "render/frame/plugin.h"

#include <dlfcn.h>
#include <elf.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <vector>

#include "render/paths/path_of_plugin.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// True if the file has all the bytes that its ELF headers list. The loader maps them without checking, and a
// truncated file would end the program with SIGBUS. The loader itself reports files that are not ELF files
// for this machine.
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

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
    throw InputError("plug-in " + file.string() + ": " + why);
}

// Never closed: its models may live as long as the program.
void* open_library(const std::filesystem::path& file) {
    std::error_code error;
    // dlopen() would wait for a pipe.
    if (!std::filesystem::is_regular_file(file, error)) refuse(file, "there is no such file");
    // For a bare name dlopen() searches the system's folders, which may have another file of that name.
    const std::filesystem::path here = std::filesystem::absolute(file, error);
    const std::uintmax_t bytes = error ? 0 : std::filesystem::file_size(here, error);
    if (error) refuse(file, "cannot be read: " + error.message());
    if (!is_whole(here, bytes))
        refuse(file, "found " + std::to_string(bytes) +
                         " bytes, fewer than its headers tell of: it was cut; " +
                         "accepted: a whole shared library");
    void* const library = dlopen(here.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) refuse(file, std::string("cannot be loaded: ") + dlerror());
    return library;
}

// The interface that this program has.
struct Interface {
    std::string name;
    std::uint32_t version, sizes;
};

// Rejects what was built for another interface, or differently from this program. info: of either kind of
// plug-in.
template <class Info>
void require_fit(const std::filesystem::path& file, const Info& info, const Interface& here) {
    if (info.interface_version != here.version)
        refuse(file, "is for " + here.name + " " + std::to_string(info.interface_version) +
                         "; this program has " + std::to_string(here.version) +
                         "; build it again with this program's headers");
    const std::string compiler = info.compiler ? info.compiler : "(none)";
    if (info.shared_sizes != here.sizes || compiler != __VERSION__)
        refuse(file, "was built by compiler " + compiler +
                         " with other headers or options than this program (" + __VERSION__ +
                         "); build it again beside it");
}

void add_path(const std::filesystem::path& file, const PathPluginInfo* info, Modules& modules) {
    if (!info)
        refuse(file,
               "is no hilcam plug-in: its hilcam_path_plugin() gives nothing; accepted: "
               "HILCAM_PATH_PLUGIN(name, Model)");
    require_fit(file, *info, {"path models' interface", kPathPluginInterface, kPathPluginSizes});
    if (!info->name || !info->make)
        refuse(file, "is no hilcam plug-in: it has no path model; accepted: HILCAM_PATH_PLUGIN(name, Model)");
    modules.paths.add(
        info->name, [make = info->make] { return make_path_of_plugin(std::unique_ptr<PathPlugin>(make())); });
}

void add_all(const std::filesystem::path& file, const PluginInfo* info, Modules& modules) {
    if (!info)
        refuse(file, "is no hilcam plug-in: its hilcam_plugin() gives nothing; accepted: HILCAM_PLUGIN(add)");
    require_fit(file, *info, {"plug-in interface", kPluginInterface, kPluginSizes});
    if (!info->add)
        refuse(file,
               "is no hilcam plug-in: it has no function that adds models; accepted: HILCAM_PLUGIN(add)");
    info->add(modules);
}

void load_plugin(const std::filesystem::path& file, Modules& modules) {
    void* const library = open_library(file);
    const auto path = reinterpret_cast<const PathPluginInfo* (*)()>(dlsym(library, "hilcam_path_plugin"));
    const auto all = reinterpret_cast<const PluginInfo* (*)()>(dlsym(library, "hilcam_plugin"));
    if (!path && !all)
        refuse(file, "is no hilcam plug-in: it has no function hilcam_plugin() or hilcam_path_plugin()");
    if (path) add_path(file, path(), modules);
    if (all) add_all(file, all(), modules);
}

}  // namespace

void load_plugins(std::span<const std::filesystem::path> files, Modules& modules) {
    for (const std::filesystem::path& file : files) load_plugin(file, modules);
}

}  // namespace hilcam
