#include "io/system/program_files.h"

#include <algorithm>

namespace hilcam {
namespace {

namespace fs = std::filesystem;

fs::path program_folder() {
    std::error_code error;
    return fs::read_symlink("/proc/self/exe", error).parent_path();
}

bool is_file(const fs::path& path) {
    std::error_code error;
    return fs::is_regular_file(path, error);
}

fs::path find_data_folder() {
    // The paths come from CMake (GNUInstallDirs).
    for (const fs::path& place :
         {program_folder() / HILCAM_DATA_FROM_PROGRAM, fs::path(HILCAM_INSTALLED_DATA)}) {
        std::error_code error;
        const fs::path folder = fs::canonical(place, error);
        if (!error && fs::is_directory(folder, error)) return folder;
    }
    return {};
}

}  // namespace

fs::path data_folder() {
    static const fs::path folder = find_data_folder();
    return folder;
}

fs::path shipped_file(const fs::path& name) {
    const fs::path folder = data_folder();
    if (folder.empty() || name.empty() || name.is_absolute()) return {};
    const fs::path plain = name.lexically_normal();
    const fs::path inside = *plain.begin() == "configs" ? plain.lexically_relative("configs") : plain;
    if (*inside.begin() == "..") return {};
    return is_file(folder / inside) ? folder / inside : fs::path();
}

fs::path named_config(const fs::path& name) {
    std::error_code error;
    if (name.empty() || fs::exists(name, error)) return name;
    if (const fs::path file = shipped_file(name); !file.empty()) return file;
    if (name.has_parent_path() || name.has_extension()) return name;
    for (const char* const kind : {"scenarios", "cameras"})
        if (const fs::path file = shipped_file(fs::path(kind) / (name.string() + ".yaml")); !file.empty())
            return file;
    return name;
}

std::vector<std::string> shipped_names() {
    std::vector<std::string> out;
    for (const char* const kind : {"scenarios", "cameras"}) {
        std::error_code error;
        const std::size_t first = out.size();
        for (const auto& entry : fs::directory_iterator(data_folder() / kind, error))
            if (entry.path().extension() == ".yaml") out.push_back(entry.path().stem().string());
        std::sort(out.begin() + static_cast<std::ptrdiff_t>(first), out.end());
    }
    return out;
}

bool is_shipped(const fs::path& folder) {
    const fs::path data = data_folder();
    std::error_code error;
    const fs::path whole = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, error);
    if (data.empty() || error) return false;
    const fs::path inside = whole.lexically_relative(data);
    return !inside.empty() && *inside.begin() != "..";
}

fs::path helper_program(const std::string& name) {
    const fs::path beside = program_folder() / name;
    const fs::path own = program_folder() / HILCAM_HELPERS_FROM_PROGRAM / name;
    return !is_file(beside) && is_file(own) ? own.lexically_normal() : beside;
}

}  // namespace hilcam
