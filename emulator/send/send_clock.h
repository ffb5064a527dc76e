#pragma once
// A sender's estimate of simulated time, and `hilcam send clock`.

#include "emulator/send/send_target.h"
#include "io/commands/clock_filter.h"
#include "io/commands/command_sender.h"

namespace hilcam {

// Exchanges clock readings by this machine's CLOCK_MONOTONIC in a packet that carries `order`, and adds the
// result to the filter. Returns the answer. Throws DeviceError.
Acknowledgement exchange_clock(CommandSender& sender, ClockCommand order, int timeout_ms,
                               ClockFilter& filter);
// Measures as many times as the filter can hold. The first packet carries `order`; returns the answer to it.
Acknowledgement measure_clock(CommandSender& sender, const ClockCommand& order, int timeout_ms,
                              ClockFilter& filter);

// Carries out the order, if there is one, and prints how simulated time runs and how well it is known.
// Returns the exit status.
int send_clock(const SendTarget& target, const ClockCommand& order);

}  // namespace hilcam
