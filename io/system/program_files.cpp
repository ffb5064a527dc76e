#include "io/system/program_files.h"

#include <sys/auxv.h>

namespace hilcam {
namespace {

namespace fs = std::filesystem;

fs::path program_folder() { return program_file().parent_path(); }

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

fs::path program_file_by(const fs::path& link) {
    std::error_code error;
    fs::path file = fs::read_symlink(link, error);
    if (!error) return file;
    // A relative path refers to the working directory at the start; the first call is then.
    const auto* const asked_for = reinterpret_cast<const char*>(getauxval(AT_EXECFN));
    if (asked_for == nullptr) return {};
    file = fs::canonical(asked_for, error);
    return error ? fs::path() : file;
}

fs::path program_file() {
    static const fs::path file = program_file_by("/proc/self/exe");
    return file;
}

fs::path own_program() {
    const fs::path link = "/proc/self/exe";
    std::error_code error;
    return fs::exists(link, error) ? link : program_file();
}

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
