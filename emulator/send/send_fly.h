#pragma once
// `hilcam send fly`: flies a circle with time-tagged poses.

#include <CLI/CLI.hpp>
#include <array>

#include "emulator/send/send_target.h"

namespace hilcam {

struct FlyOptions {
    unsigned object = 0;
    std::array<double, 3> around_m{}, from_m{0, -40, 0}, axis{0, 0, 1}, up{0, 0, 1};
    double period_s = 60, rate_hz = 50, duration_s = 20;
};
void add_fly_options(CLI::App& app, FlyOptions& options);
// Prints counts and round-trip times. Returns the exit status.
int send_flight(const SendTarget& target, const FlyOptions& options);

}  // namespace hilcam
