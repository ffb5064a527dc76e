#include "io/v4l2/v4l2_module.h"

#include <charconv>
#include <filesystem>
#include <fstream>

namespace hilcam {

std::optional<LoopbackVersion> parse_loopback_version(std::string_view text) {
    LoopbackVersion version;
    const char* at = text.data();
    const char* const end = at + text.size();
    for (int* number : {&version.major, &version.minor, &version.patch}) {
        const auto [next, error] = std::from_chars(at, end, *number);
        if (error != std::errc{} || *number < 0) return std::nullopt;
        if (number == &version.patch) break;
        if (next == end || *next != '.') return std::nullopt;
        at = next + 1;
    }
    return version;
}

std::string LoopbackModule::name() const {
    if (!loaded) return "none";
    if (!version) return "before 0.13";
    return std::to_string(version->major) + "." + std::to_string(version->minor) + "." +
           std::to_string(version->patch);
}

LoopbackModule loaded_loopback_module() {
    const std::filesystem::path folder = "/sys/module/v4l2loopback";
    LoopbackModule module;
    std::error_code error;
    module.loaded = std::filesystem::is_directory(folder, error);
    std::ifstream file(folder / "version");
    std::string text;
    if (std::getline(file, text)) module.version = parse_loopback_version(text);
    return module;
}

}  // namespace hilcam
