#pragma once
// Bounds that a run has to keep (`loop.fail_on`). A run that breaks one goes on to its end as any other,
// names the bound, its value and the first frame in its last lines and report, and exits with status 1
// (emulator/run/broken_bounds.h). The key of each field says what it bounds; all times are of
// CLOCK_MONOTONIC.

#include <cstdint>

#include "render/vocabulary/config_field.h"

namespace hilcam {

struct RunBounds {
    static constexpr double kNone = -1;

    double latency_s = kNone, latency_p999_s = kNone, exposure_latency_s = kNone;
    double missed_exposures = kNone, dropped_packets = kNone, dropped_frames = kNone;
    // Frames from this id on count for the bounds on latency and on missed exposures. Earlier ones are late
    // on every machine, while caches fill and processors wake.
    std::int64_t from_frame = 11;

    bool times_commands() const { return latency_s >= 0 || latency_p999_s >= 0; }
    bool times_frames() const { return times_commands() || exposure_latency_s >= 0; }
    bool any() const {
        return times_frames() || missed_exposures >= 0 || dropped_packets >= 0 || dropped_frames >= 0;
    }
};
Fields fields(RunBounds& bounds);

// Both throw KeyError or InputError for bounds on what the clock says about frames that the clock does not
// make: in lockstep they wait for commands, and a replay has the recording's exposures.
void require_lockstep(const RunBounds& bounds);
void require_replay(const RunBounds& bounds);
// Throws InputError for bounds on latency when no output takes the time of its frames.
void require_timed_output(const RunBounds& bounds, bool has_timed_output);

}  // namespace hilcam
