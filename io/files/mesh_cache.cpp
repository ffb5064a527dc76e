#include "io/files/mesh_cache.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <regex>

#include "io/system/program_files.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// Raised when a generator makes another mesh of the same arguments.
constexpr int kMeshVersion = 2;

int run(const std::filesystem::path& program, std::vector<std::string> words) {
    std::vector<char*> argv;
    argv.reserve(words.size() + 1);
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    pid_t child = 0;
    if (posix_spawn(&child, program.c_str(), nullptr, nullptr, argv.data(), environ) != 0) return -1;
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// Names that caches give their files: "levels_123.bin", "hilcam-make-spacecraft_seed_1.glb"; and what is left
// of one that was being written: "levels_123.bin.4711".
std::vector<std::filesystem::path> cached_files(const std::filesystem::path& folder) {
    static const std::regex name(
        R"((atmosphere|levels|reference|transfer)_\d+.*\.bin(\.\d+)?|hilcam-[\w-]+_.*\.glb)");
    std::vector<std::filesystem::path> files;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error))
        if (std::regex_match(entry.path().filename().string(), name) && !entry.is_symlink(error) &&
            entry.is_regular_file(error))
            files.push_back(entry.path());
    return files;
}

}  // namespace

std::filesystem::path cache_folder() {
    if (const char* own = std::getenv("HILCAM_CACHE"); own && *own) return own;
    if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && *xdg)
        return std::filesystem::path(xdg) / "hilcam";
    if (const char* home = std::getenv("HOME"); home && *home)
        return std::filesystem::path(home) / ".cache" / "hilcam";
    return std::filesystem::temp_directory_path() / "hilcam";
}

CacheSize cache_size(const std::filesystem::path& folder) {
    CacheSize size;
    for (const auto& file : cached_files(folder)) {
        std::error_code error;
        const std::uintmax_t bytes = std::filesystem::file_size(file, error);
        if (error) continue;
        ++size.files;
        size.bytes += bytes;
    }
    return size;
}

CacheSize clear_cache(const std::filesystem::path& folder) {
    const CacheSize size = cache_size(folder);
    for (const auto& file : cached_files(folder)) {
        std::error_code error;
        std::filesystem::remove(file, error);
        if (error) throw DeviceError(file.string() + " cannot be removed: " + error.message());
    }
    return size;
}

std::filesystem::path generated_mesh(const std::string& program, const std::vector<std::string>& arguments,
                                     const std::filesystem::path& folder) {
    const auto plain = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_';
    };
    if (program.empty() || !std::all_of(program.begin(), program.end(), plain))
        throw InputError("mesh generator " + in_quotes(program) +
                         ": accepted: the name of a program beside hilcam, as " + "hilcam-make-spacecraft");
    std::string name = program;
    for (const std::string& argument : arguments) {
        const std::string word = argument.substr(std::min(argument.find_first_not_of('-'), argument.size()));
        name += "_";
        for (const char c : word) name += plain(c) || c == '.' ? c : '-';
    }
    std::filesystem::path file = folder / (name + "_v" + std::to_string(kMeshVersion) + ".glb");
    if (std::filesystem::exists(file)) return file;

    const auto beside = helper_program(program);
    if (!std::filesystem::exists(beside))
        throw InputError("mesh generator " + beside.string() +
                         " is missing; build it, or give the object a mesh file");
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw DeviceError("cache folder " + folder.string() + " cannot be made: " + error.message());
    std::vector<std::string> words = {program};
    words.insert(words.end(), arguments.begin(), arguments.end());
    words.insert(words.end(), {"--out", file.string()});
    const int status = run(beside, words);
    if (status == 2) throw InputError("mesh generator " + program + " refuses its arguments (see above)");
    if (status != 0 || !std::filesystem::exists(file))
        throw DeviceError("mesh generator " + program + " failed with status " + std::to_string(status) +
                          " for " + file.string());
    return file;
}

}  // namespace hilcam
