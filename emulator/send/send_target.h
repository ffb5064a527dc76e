#pragma once
// The emulator that `hilcam send` talks to.

#include <cstdint>
#include <string>

#include "io/commands/command_dialect.h"

namespace hilcam {

struct SendTarget {
    std::string endpoint = "127.0.0.1:5010";
    DialectConfig dialect{};
    int timeout_ms = 1000;
    std::uint16_t camera = 0;  // 0: all cameras
};

}  // namespace hilcam
