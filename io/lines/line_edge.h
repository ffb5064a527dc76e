#pragma once
// A line of the camera, and an edge of it.
//
// Line0 is an input. Others exist where a scenario lists them (lines_config.h). Levels are those of the wire;
// LineInverter stands between the wire and the camera.

#include <array>
#include <cstddef>
#include <cstdint>

namespace hilcam {

inline constexpr std::size_t kLines = 8;  // Line0 to Line7

struct LineEdge {
    std::uint8_t line = 0;
    bool level = false;             // the wire's level from then on
    std::int64_t monotonic_ns = 0;  // CLOCK_MONOTONIC
    std::uint32_t sequence = 0;     // number of the edge at its source; frames keep it as their trigger's

    friend bool operator==(const LineEdge&, const LineEdge&) = default;
};

}  // namespace hilcam
