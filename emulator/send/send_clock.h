#pragma once
// The simulated time as a sender on this machine, or another, knows it; and `hilcam send clock`.

#include "emulator/send/send_target.h"
#include "io/commands/clock_filter.h"
#include "io/commands/command_sender.h"

namespace hilcam {

// An exchange of clock readings by CLOCK_MONOTONIC of this machine, which carries `order`: into the filter.
// Gives the answer. Throws DeviceError.
Acknowledgement exchange_clock(CommandSender& sender, ClockCommand order, int timeout_ms,
                               ClockFilter& filter);
// Measures as many times as the filter keeps; the first carries `order`. Gives its answer.
Acknowledgement measure_clock(CommandSender& sender, const ClockCommand& order, int timeout_ms,
                              ClockFilter& filter);

// Carries out the order, if it is one, and prints how simulated time goes and how well it is known. Gives the
// exit status.
int send_clock(const SendTarget& target, const ClockCommand& order);

}  // namespace hilcam
