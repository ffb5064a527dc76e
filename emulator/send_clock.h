#pragma once
// The simulated time as a sender on this machine, or another, knows it; and `hilcam send clock`.

#include "emulator/send_target.h"
#include "io/clock_filter.h"
#include "io/command_sender.h"

namespace hilcam {

// Exchanges of clock readings by CLOCK_MONOTONIC of this machine, `count` of them; the first carries `order`.
// `first`: its answer. Throws DeviceError.
ClockFilter measure_clock(CommandSender& sender, const ClockCommand& order, int count, int timeout_ms,
                          Acknowledgement& first);

// Carries out the order, if it is one, and prints how simulated time goes and how well it is known. Gives the
// exit status.
int send_clock(const SendTarget& target, const ClockCommand& order);

}  // namespace hilcam
