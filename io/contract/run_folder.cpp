#include "io/contract/run_folder.h"

#include <algorithm>
#include <vector>

#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

constexpr std::size_t kDigits = 8;  // digits of a frame's number in a file's name, at least

std::vector<std::filesystem::path> files_of_run(const RunFolder& f) {
    std::vector<std::filesystem::path> found;
    std::error_code error;
    for (auto it = std::filesystem::directory_iterator(f.folder, error);
         !error && it != std::filesystem::directory_iterator(); it.increment(error))
        if (f.is_own(it->path().filename().string()) && !it->is_directory(error)) found.push_back(it->path());
    std::sort(found.begin(), found.end());
    return found;
}

}  // namespace

bool is_numbered(std::string_view name, std::string_view stem) {
    if (!name.starts_with(stem) || name.size() < stem.size() + 1 + kDigits || name[stem.size()] != '_')
        return false;
    const std::string_view number = name.substr(stem.size() + 1, kDigits);
    return std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; });
}

std::string used_by_another_run(const RunFolder& f) {
    const std::vector<std::filesystem::path> found = files_of_run(f);
    if (found.empty()) return {};
    return f.key + ".folder: found '" + harmless(f.folder.string()) + "', which holds " +
           (found.size() == 1 ? "a file" : std::to_string(found.size()) + " files") + " of another run (" +
           in_quotes(found.front().filename().string()) + (found.size() == 1 ? "" : " is the first") +
           "); accepted: an empty folder, another folder, or " + f.key +
           ".overwrite: true, which replaces all of them";
}

void require_unused(const RunFolder& f) {
    if (f.overwrite) return;
    if (const std::string used = used_by_another_run(f); !used.empty()) throw InputError(used);
}

void claim(const RunFolder& f) {
    require_unused(f);
    std::error_code error;
    for (const std::filesystem::path& old : files_of_run(f)) {
        std::filesystem::remove(old, error);
        if (error)
            throw DeviceError(f.key + ".overwrite: " + old.string() +
                              " cannot be removed: " + error.message());
    }
    std::filesystem::create_directories(f.folder, error);
    if (error)
        throw DeviceError(f.key + ".folder: " + f.folder.string() + " cannot be made: " + error.message());
}

}  // namespace hilcam
