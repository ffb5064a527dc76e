#pragma once
// Finds the version of the loaded v4l2loopback, and what must be avoided with it.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace hilcam {

struct LoopbackVersion {
    int major = 0, minor = 0, patch = 0;
    friend auto operator<=>(const LoopbackVersion&, const LoopbackVersion&) = default;
};
// Parses "0.15.0"; nothing for other text.
std::optional<LoopbackVersion> parse_loopback_version(std::string_view text);

struct LoopbackModule {
    bool loaded = false;
    // Nothing for modules before 0.13, which do not report their version.
    std::optional<LoopbackVersion> version;

    // True before 0.14, where all programs share one queue in the module. Then:
    // - DQBUF gives a writer the newest frame, which a reader may be reading, so we choose the buffer
    //   ourselves.
    // - A reader that requests fewer buffers removes them for everybody, permanently, and renumbers the rest,
    //   so we ask for a buffer's place before each frame.
    // - write() races with that: an entry may be removed from a list while a frame is copied, and the kernel
    //   panics (measured: within a second, with an unpaced writer and a reader).
    bool shared_queue() const { return loaded && (!version || *version < LoopbackVersion{0, 14, 0}); }
    // False before 0.13: frames queued through mmap are not counted, and their times are not marked as the
    // producer's.
    bool counts_mapped_frames() const { return !loaded || version.has_value(); }
    // Returns "0.15.0", "before 0.13" or "none".
    std::string name() const;
};

// Reads /sys/module.
LoopbackModule loaded_loopback_module();

}  // namespace hilcam
