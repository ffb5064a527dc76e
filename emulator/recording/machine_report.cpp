#include "emulator/recording/machine_report.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

namespace hilcam {
namespace {

#ifdef __clang__
constexpr const char* kCompiler = "clang ";
#else
constexpr const char* kCompiler = "gcc ";
#endif
#ifdef NDEBUG
constexpr const char* kBuild = "optimised";
#else
constexpr const char* kBuild = "debug";
#endif

}  // namespace

std::string processor_name() {
    std::ifstream in("/proc/cpuinfo");
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown";
}

nlohmann::json machine_report() {
    return {{"processor", processor_name()},
            {"cores", std::thread::hardware_concurrency()},
            {"compiler", std::string(kCompiler) + __VERSION__},
            {"build", kBuild}};
}

}  // namespace hilcam
