#pragma once
// Finds which v4l2loopback is loaded, and what that version must not be asked.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace hilcam {

struct LoopbackVersion {
    int major = 0, minor = 0, patch = 0;
    friend auto operator<=>(const LoopbackVersion&, const LoopbackVersion&) = default;
};
// "0.15.0"; nothing for other text.
std::optional<LoopbackVersion> parse_loopback_version(std::string_view text);

struct LoopbackModule {
    bool loaded = false;
    // Modules before 0.13 do not tell theirs.
    std::optional<LoopbackVersion> version;

    // True before 0.14, where the module's queue is one for all programs. Then
    //  - DQBUF hands a writer the newest frame, which a reader may be reading: we choose the buffer
    //  ourselves;
    //  - any reader that asks for fewer buffers takes them from all, for good, and renumbers them: we ask
    //  where
    //    a buffer is before each frame;
    //  - write() races with that: a list entry may be removed while a frame is copied, which panics the
    //  kernel
    //    (measured: an unpaced writer and a reader, within a second).
    bool shared_queue() const { return loaded && (!version || *version < LoopbackVersion{0, 14, 0}); }
    // False before 0.13: frames queued by mmap are not counted, nor their times marked as the producer's.
    bool counts_mapped_frames() const { return !loaded || version.has_value(); }
    // "0.15.0", "before 0.13", "none".
    std::string name() const;
};

// Reads /sys/module.
LoopbackModule loaded_loopback_module();

}  // namespace hilcam
