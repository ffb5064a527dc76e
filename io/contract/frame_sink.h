#pragma once
// A sink takes finished frames: for a GigE Vision client, a V4L2 device, files. The loop hands every sink
// every frame.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "render/vocabulary/image.h"
#include "render/vocabulary/pose.h"
#include "render/vocabulary/time.h"

namespace hilcam {

// The data that travel with a frame. Monotonic times are CLOCK_MONOTONIC nanoseconds; 0 means "none".
struct FrameRecord {
    std::uint64_t id = 0;                        // 1, 2, 3, ... of this run; skipped frames leave a gap
    TimeTai exposure_mid;                        // simulated time
    std::int64_t exposure_mid_monotonic_ns = 0;  // the same instant on the machine's clock
    double exposure_s = 0;
    double gain_db = 0;
    double black_level_dn = 0;
    int bits = 0;  // significant bits of a DN
    std::int64_t binning_x = 1, binning_y = 1;
    // Sequence number of the newest command that had arrived when rendering began.
    std::uint32_t pose_sequence = 0;
    TimeTai pose_time;                   // that command's time tag
    std::uint32_t trigger_sequence = 0;  // sequence number of the `expose` that asked for it
    std::uint64_t faults =
        0;  // bits of the faults that strike it (fault.h), those of packets apart; and above
    std::uint32_t quality_level = 0;  // 0: as configured
    bool reverse_x = false, reverse_y = false;
    bool has_truth = false;  // its truth is given out (docs/truth.md)
    // Pose of the camera at mid-exposure, its pointing jitter in it; none: the shutter stayed closed.
    std::optional<Pose> camera;
    std::int64_t command_arrival_monotonic_ns =
        0;  // when that command arrived; 0 when no new one came since the last frame
};

class TruthListener;

// Tells what has become of the frames that an output got: it delivered them, lost them, or nobody took frames then.
struct SinkReport {
    std::string name;          // "gige 127.0.0.1", "v4l2 /dev/video42", "files out/x"
    std::uint64_t frames = 0;  // delivered
    // Frames that somebody was to get and did not: the sink is too slow, the disk full, a fault was ordered.
    std::uint64_t dropped = 0;
    std::string fault{};         // empty, or why frames are lost that nobody allowed to be lost
    std::uint64_t unwanted = 0;  // frames that nobody took: no client, no host, not acquiring
    // More figures by name: packets resent, clients, ...
    std::vector<std::pair<std::string, double>> figures{};
};

// The events that happen to a frame before it is there.
struct CameraEvent {
    enum class Kind : std::uint8_t { kExposureStart, kExposureEnd, kTriggerMissed } kind;
    std::uint64_t frame = 0;  // 0: of none (a missed trigger)
    std::int64_t monotonic_ns = 0;
};

class FrameSink {
  public:
    virtual ~FrameSink() = default;
    // Opens what it needs and starts its own threads. Throws InputError or DeviceError. Owner thread.
    virtual void start() = 0;
    // Takes a copy of the frame and returns; never waits for a client or a device. Loop. The image may be
    // overwritten as soon as this returns.
    virtual void publish(const DnImage& frame, const FrameRecord& record) noexcept = 0;
    // False while the next publish() would drop a frame that somebody takes, because the one before is not
    // out yet: never for long, and not where nobody takes frames (no client, the device gone, the sink
    // stopped). Lockstep waits for it. Loop.
    virtual bool has_room() const noexcept { return true; }
    // True when the loop has to wait for has_room() also outside lockstep (when_slow.h). Loop.
    virtual bool must_be_waited_for() const noexcept { return false; }
    // Loop and any other thread, at the same time: never waits. An exposure's end is told by publish()'s
    // thread, right before that frame's publish().
    virtual void on_event(const CameraEvent&) noexcept {}
    // Ends the threads and closes everything; idempotent. Owner thread.
    virtual void stop() noexcept = 0;
    // Any thread.
    virtual SinkReport report() const = 0;
    // Null, or who wants the truth of frames that this output shows (truth_listener.h); asked before start().
    virtual TruthListener* truth_listener() noexcept { return nullptr; }
    // True when report() names a fault; for who asks often, and may not allocate. Any thread.
    virtual bool has_fault() const noexcept { return false; }
};

// Told by sinks when the first and the last byte of a frame have left; times are CLOCK_MONOTONIC ns. Called
// from the sink's own thread: no lock, no allocation.
class DeliveryListener {
  public:
    virtual ~DeliveryListener() = default;
    virtual void delivered(const FrameRecord& record, std::int64_t first_ns,
                           std::int64_t last_ns) noexcept = 0;
};

class CameraControl;
class FaultBoard;
class FrameFates;
class LightPartSource;

// The surroundings of a sink; all of it outlives the sink.
struct SinkContext {
    CameraControl& camera;
    FaultBoard& faults;
    DeliveryListener* listener = nullptr;    // may be null
    FrameFates* fates = nullptr;             // gets what becomes of frames' files; may be null
    LightPartSource* light_parts = nullptr;  // takes frames apart for who asks; may be null
};

}  // namespace hilcam
