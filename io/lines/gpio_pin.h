#pragma once
// A pin of a GPIO chip, by the kernel's character device (linux/gpio.h, uAPI v2: Linux 5.10 and later).
//
// The kernel's interface in place of libgpiod: libgpiod 1 and 2, of Debian 12 and 13, have different
// functions for the same, and the kernel's does not change.

#include <cstdint>
#include <span>
#include <string>

#include "io/lines/lines_config.h"
#include "io/system/fd.h"

namespace hilcam {

// Opens an input, whose edges can be read from its descriptor with the kernel's times (CLOCK_MONOTONIC), or
// an output at a level. Throws DeviceError that says what is missing.
Fd open_input_pin(const PinConfig& pin);
Fd open_output_pin(const PinConfig& pin, bool level);

// Returns why the pin cannot be used, as far as that shows without taking it; empty: it can.
std::string fault_of(const PinConfig& pin);

bool read_pin(const Fd& pin);
// False: the chip is gone.
bool write_pin(const Fd& pin, bool level);

struct PinEdge {
    bool level = false;
    std::int64_t monotonic_ns = 0;
    std::uint32_t sequence = 0;  // the kernel's number of this pin's edge, from 1; gaps: its buffer was full
};
// Reads the edges that wait; at most as many as fit. Does not wait when the descriptor can be read. Returns
// how many there were.
std::size_t read_edges(const Fd& pin, std::span<PinEdge> edges);

}  // namespace hilcam
