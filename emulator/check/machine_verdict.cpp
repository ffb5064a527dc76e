#include "emulator/check/machine_verdict.h"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "io/system/net_interface.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

using Lines = std::vector<std::string>;

void look_at_interface(const ScenarioConfig& s, Lines& out) {
    const auto* gige = s.outputs.find<GigeConfig>();
    if (!gige) return;
    try {
        const NetInterface interface = find_interface(gige->interface);
        if (gige->packet_bytes > interface.mtu_bytes)
            out.push_back(
                s.places.at("outputs.gige.packet_bytes",
                            fmt::format("outputs.gige.packet_bytes is {}, and the interface {} carries {}",
                                        gige->packet_bytes, interface.name, interface.mtu_bytes)));
    } catch (const InputError& error) {
        out.push_back(s.places.at("outputs.gige.interface", std::string("outputs.gige: ") + error.what()));
    }
}

// Says why nothing can be written to a folder; empty: it can. Access rights do not suffice: root cannot write
// in /proc, and no user can write on a read-only file system.
std::string why_not_writable(std::filesystem::path folder) {
    std::error_code error;
    folder = std::filesystem::absolute(folder, error).lexically_normal();
    while (!std::filesystem::exists(folder, error) && folder.has_relative_path())
        folder = folder.parent_path();
    if (!std::filesystem::is_directory(folder, error)) return in_quotes(folder.string()) + " is no folder";
    std::string probe = (folder / ".hilcam-XXXXXX").string();
    if (!mkdtemp(probe.data()))
        return "nothing can be written in " + in_quotes(folder.string()) + ": " + std::strerror(errno);
    rmdir(probe.c_str());
    return {};
}

void look_at_folders(const ScenarioConfig& s, Lines& out) {
    for (const RunFolder& folder : run_folders(s.outputs)) {
        const std::string key = folder.key + ".folder";
        if (const std::string why = why_not_writable(folder.folder); !why.empty())
            out.push_back(
                s.places.at(key, key + ": found " + in_quotes(folder.folder.string()) + ", and " + why));
        else if (std::string used = folder.overwrite ? "" : used_by_another_run(folder); !used.empty())
            out.push_back(s.places.at(key, used));
    }
}

}  // namespace

std::vector<std::string> machine_warnings(const ScenarioConfig& scenario) {
    Lines out;
    look_at_interface(scenario, out);
    look_at_folders(scenario, out);
    return out;
}

}  // namespace hilcam
