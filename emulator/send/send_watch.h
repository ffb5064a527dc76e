#pragma once
// `hilcam send watch`: telemetry on the terminal, one line a packet.

#include <CLI/CLI.hpp>
#include <string>

#include "emulator/send/send_target.h"
#include "io/commands/telemetry_codec.h"

namespace hilcam {

struct WatchOptions {
    double duration_s = 0;     // 0: until it is stopped
    std::uint64_t frames = 0;  // 0: no limit
    bool housekeeping_only = false, json = false;
};
void add_watch_options(CLI::App& app, WatchOptions& options);
// Gives the exit status; throws DeviceError when the emulator is not there or goes.
int watch_telemetry(const SendTarget& target, const WatchOptions& options);

// A line for people, or a JSON object. several: there are cameras to be told apart.
std::string text_of(const Telemetry& telemetry, bool several = false);
std::string json_of(const Telemetry& telemetry);

}  // namespace hilcam
