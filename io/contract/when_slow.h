#pragma once
// The key `when_slow` of outputs that fill a folder: what happens to a frame that arrives before the earlier
// ones are written. In lockstep and in replays the camera always waits.

#include <cstdint>
#include <filesystem>
#include <string>

#include "render/vocabulary/config_field.h"

namespace hilcam {

enum class WhenSlow { kAuto, kWait, kDrop };

inline Field when_slow(WhenSlow& value) {
    return choice("when_slow", value, {"auto", "wait", "drop"},
                  "treatment of frames that come faster than they are written. wait: the camera waits, and "
                  "misses exposures; drop: frames are dropped and reported, without a fault; auto: drop "
                  "beside gige, v4l2, uvc, shm and packets to sockets, whose clients must not wait for a "
                  "disk, else wait; a frame "
                  "lost with auto is a fault (exit status 1)");
}

// True when the camera waits for the output. has_live_output: another output sends the same frames to
// clients.
inline bool waits(WhenSlow value, bool has_live_output) {
    return value == WhenSlow::kWait || (value == WhenSlow::kAuto && !has_live_output);
}

// Returns the message that frames were lost against the user's wish. key: "outputs.files".
inline std::string report_of_drops(const std::string& key, const std::filesystem::path& folder,
                                   std::uint64_t dropped, std::uint64_t written) {
    return key + ": " + std::to_string(dropped) + " of " + std::to_string(dropped + written) +
           " frames came too fast for '" + folder.string() + "' and were lost; accepted: " + key +
           ".when_slow: wait, which loses none, drop, which allows it, or a larger every_nth";
}

// Returns the message that frames could not be written. first: why the first of them was lost.
inline std::string report_of_failures(const std::string& first, std::uint64_t failed) {
    return first +
           (failed == 1 ? " (1 frame lost)" : " (the first of " + std::to_string(failed) + " frames lost)");
}

}  // namespace hilcam
