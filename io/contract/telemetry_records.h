#pragma once
// The telemetry that the camera sends unasked: a report for every frame, and housekeeping once a second.

#include <cstdint>
#include <variant>

#include "render/vocabulary/time.h"

namespace hilcam {

struct FrameReport {
    std::uint8_t camera = 1;                     // number of the camera, from 1, as in commands
    std::uint64_t frame = 0;                     // FrameRecord::id
    TimeTai exposure_mid;                        // simulated time
    std::int64_t exposure_mid_monotonic_ns = 0;  // the same instant on the machine's clock
    double exposure_s = 0;
    double gain_db = 0;
    std::uint32_t pose_sequence = 0;  // sequence number of the newest command that the frame shows
    TimeTai pose_time;                // time tag of that command
    std::uint32_t trigger_sequence = 0;
    std::int64_t latency_ns = -1;  // from that command's arrival to the frame's hand-over; -1: no new command
    std::uint64_t faults = 0;      // FrameRecord::faults
    std::uint32_t quality_level = 0;
};

enum class OperatingMode : std::uint8_t { kFreeRun = 0, kTriggered = 1, kLockstep = 2 };

struct HousekeepingFigures {
    OperatingMode mode = OperatingMode::kFreeRun;
    bool running = false;
    TimeTai simulated_time;
    std::int64_t monotonic_ns = 0;
    double uptime_s = 0;
    std::uint64_t frames = 0;
    double frame_rate_hz = 0;  // over the last second
    std::uint64_t deadline_misses = 0;
    std::uint64_t commands_received = 0, commands_refused = 0, commands_lost = 0;
    double latency_p50_s = 0, latency_p99_s = 0;  // from a command's arrival to the last packet of its frame
    double temperature_c = 0;                     // detector temperature
    std::uint32_t active_faults = 0;              // number of fault kinds in force
    std::uint32_t clients = 0;                    // clients of commands and telemetry
};

using Telemetry = std::variant<FrameReport, HousekeepingFigures>;

}  // namespace hilcam
