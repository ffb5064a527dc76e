#pragma once
// The newest command that a frame shows.

#include <cstdint>

#include "render/vocabulary/time.h"

namespace hilcam {

struct ShownCommand {
    std::uint32_t sequence = 0;
    std::int64_t arrival_monotonic_ns = 0;  // 0: none yet
    TimeTai time{};                         // time tag; set by WorldState
    std::uint64_t number = 0;               // number in the recording, from 1; 0: not recorded
};

}  // namespace hilcam
