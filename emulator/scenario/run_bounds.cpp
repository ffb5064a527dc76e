#include "emulator/scenario/run_bounds.h"

#include <array>
#include <string>
#include <utility>

#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"

namespace hilcam {
namespace {

Field bound(std::string_view key, double& value, double si_per_unit, double most, std::string_view meaning) {
    return or_word(number(key, value, si_per_unit, {0, most}, meaning), "none", RunBounds::kNone);
}

// Returns the key of the first bound on times or missed exposures, with its value; an empty key: there is
// none.
std::pair<std::string, double> first_timed(const RunBounds& b, bool with_missed) {
    const std::array<std::pair<const char*, double>, 4> keys = {
        {{"latency_ms", b.latency_s * 1e3},
         {"latency_p999_ms", b.latency_p999_s * 1e3},
         {"exposure_latency_ms", b.exposure_latency_s * 1e3},
         {"missed_exposures", with_missed ? b.missed_exposures : RunBounds::kNone}}};
    for (const auto& [key, value] : keys)
        if (value >= 0) return {std::string("loop.fail_on.") + key, value};
    return {};
}

}  // namespace

Fields fields(RunBounds& b) {
    return {
        bound(
            "latency_ms", b.latency_s, 1e-3, 1e9,
            "longest time from the arrival of a command until the last packet of the first frame that shows "
            "it (v4l2, uvc, shm: until the frame is handed over)"),
        bound("latency_p999_ms", b.latency_p999_s, 1e-3, 1e9,
              "the same for 999 of 1000 frames that show a new command (right within 2.2 %)"),
        bound("exposure_latency_ms", b.exposure_latency_s, 1e-3, 1e9,
              "longest time from the middle of an exposure until the frame's last packet, with or without a "
              "new "
              "command"),
        bound("missed_exposures", b.missed_exposures, 1, 1e15,
              "most exposures that may be skipped, or triggered more than a period late"),
        bound(
            "dropped_packets", b.dropped_packets, 1, 1e15,
            "most packets of GigE frames that the kernel may refuse; those that ordered faults take away do "
            "not count"),
        bound(
            "dropped_frames", b.dropped_frames, 1, 1e15,
            "most frames that outputs may lose against their receivers' wish, over all outputs of a camera; "
            "those that ordered faults take away do not count"),
        integer(
            "from_frame", b.from_frame, {1, 1e15},
            "the first frame that counts for latencies and missed exposures, because the first ones are late "
            "on every machine; dropped packets and frames count from the begin"),
    };
}

void require_lockstep(const RunBounds& bounds) {
    const auto [key, value] = first_timed(bounds, true);
    if (!key.empty())
        throw KeyError(key,
                       "found " + plain(value) +
                           "; accepted with 'mode: lockstep': none, as its frames wait for commands and not "
                           "for the clock (dropped_packets and dropped_frames are accepted)");
}

void require_replay(const RunBounds& bounds) {
    const auto [key, value] = first_timed(bounds, true);
    if (!key.empty())
        throw refused(key, plain(value),
                      "none with --replay, which has the recording's exposures (--set " + key + "=none)");
}

void require_timed_output(const RunBounds& bounds, bool has_timed_output) {
    const auto [key, value] = first_timed(bounds, false);
    if (!key.empty() && !has_timed_output)
        throw refused(key, plain(value),
                      "none without outputs.gige, v4l2, uvc, shm or packets to a socket, which alone say "
                      "when a frame has left");
}

}  // namespace hilcam
