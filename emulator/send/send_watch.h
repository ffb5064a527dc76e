#pragma once
// `hilcam send watch`: prints telemetry on the terminal, one line for each packet.

#include <CLI/CLI.hpp>
#include <string>

#include "emulator/send/send_target.h"
#include "io/commands/telemetry_codec.h"

namespace hilcam {

struct WatchOptions {
    double duration_s = 0;     // 0: until stopped
    std::uint64_t frames = 0;  // 0: no limit
    bool housekeeping_only = false, json = false;
};
void add_watch_options(CLI::App& app, WatchOptions& options);
// Returns the exit status. Throws DeviceError when the emulator cannot be reached or goes away.
int watch_telemetry(const SendTarget& target, const WatchOptions& options);

// Return a line for people, or a JSON object. several: names the camera.
std::string text_of(const Telemetry& telemetry, bool several = false);
std::string json_of(const Telemetry& telemetry);

}  // namespace hilcam
