#pragma once
// A sink takes finished frames for an output: a GigE Vision client, a V4L2 device, files. The loop gives
// every frame to every sink.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "render/vocabulary/image.h"
#include "render/vocabulary/pose.h"
#include "render/vocabulary/time.h"

namespace hilcam {

// The data of a frame. Monotonic times are CLOCK_MONOTONIC nanoseconds; 0 means "none".
struct FrameRecord {
    std::uint64_t id = 0;                        // 1, 2, 3, ... in this run; a skipped frame leaves a gap
    TimeTai exposure_mid;                        // simulated time
    std::int64_t exposure_mid_monotonic_ns = 0;  // the same instant on the machine's clock
    double exposure_s = 0;
    double gain_db = 0;
    double black_level_dn = 0;
    int bits = 0;  // significant bits of a DN
    std::int64_t binning_x = 1, binning_y = 1;
    // Sequence number of the newest command that had arrived when rendering began.
    std::uint32_t pose_sequence = 0;
    TimeTai pose_time;                   // time tag of that command
    std::uint32_t trigger_sequence = 0;  // sequence number of the `expose` that asked for the frame
    std::int64_t sequencer_set = -1;     // the sequencer's set that it used; -1: the sequencer was off
    // Bits of ordered faults that strike it, except those of packets (fault.h), and flags (frame_flags.h).
    std::uint64_t faults = 0;
    std::uint32_t quality_level = 0;  // 0: as configured
    bool reverse_x = false, reverse_y = false;
    bool has_truth = false;  // its truth is sent out (docs/truth.md)
    // Pose of the camera at mid-exposure, with pointing jitter; nothing when the shutter stayed closed.
    std::optional<Pose> camera;
    // Arrival of the command of pose_sequence; 0 when no new one came since the previous frame.
    std::int64_t command_arrival_monotonic_ns = 0;
};

class TruthListener;

// The clock of an output's time stamps.
struct ClockReport {
    std::string source;  // tai, ptp, free
    std::string state;   // one of IEEE 1588's port states
    std::string scale;   // monotonic, device, arbitrary, UTC, TAI
    std::optional<std::int64_t> offset_from_master_ns{}, mean_path_delay_ns{};
    std::optional<double> rate_correction_ppm{};  // the servo adds it to the clock's rate
    std::uint32_t steps = 0;
    std::string master{};  // EUI-64; empty: none
};

// Says what became of an output's frames: delivered, lost, or wanted by nobody.
struct SinkReport {
    std::string name;          // "gige 127.0.0.1", "v4l2 /dev/video42", "files out/x"
    std::uint64_t frames = 0;  // delivered
    // Frames that a client or file should have got and did not: the sink is too slow, the disk is full, a
    // fault was ordered.
    std::uint64_t dropped = 0;
    std::string fault{};         // why frames were lost against the user's wish; empty: none were
    std::uint64_t unwanted = 0;  // frames that nobody took: no client, no host, no acquisition
    // Further figures by name: resent packets, clients, ...
    std::vector<std::pair<std::string, double>> figures{};
    // The dropped frames that ordered faults took away, and the first frame that was dropped otherwise; 0:
    // none, or not known.
    std::uint64_t dropped_by_faults = 0, first_dropped = 0;
    // Packets of frames that were to be sent and were not, without those that faults took away, and the first
    // frame that lacks one.
    std::uint64_t packets_lost = 0, first_with_lost_packet = 0;
    std::optional<ClockReport> clock{};  // nothing: the output has no clock of its own
};

// Something that happened at an output and belongs into the log.
struct SinkNote {
    std::string text;  // begins with the output's name
    bool warning = false;
};

// An event of the camera that comes before its frame does, or an edge of its line 0.
struct CameraEvent {
    enum class Kind : std::uint8_t {
        kExposureStart,
        kExposureEnd,
        kTriggerMissed,
        kLine0Rises,
        kLine0Falls
    } kind;
    std::uint64_t frame = 0;  // 0: no frame (a missed trigger, an edge)
    std::int64_t monotonic_ns = 0;
    std::int64_t end_ns = 0;  // kExposureStart: the exposure's end, CLOCK_MONOTONIC
};

class FrameSink {
  public:
    virtual ~FrameSink() = default;
    // Opens what it needs and starts its own threads. Throws InputError or DeviceError. Owner thread.
    virtual void start() = 0;
    // Copies the frame and returns, without waiting for a client or a device. The image may be overwritten as
    // soon as this returns. Loop.
    virtual void publish(const DnImage& frame, const FrameRecord& record) noexcept = 0;
    // False while the next publish() would drop a frame that a client takes, because the sink has not
    // finished the previous one. It soon becomes true again, and is true where nobody takes frames (no
    // client, device gone, sink stopped). Lockstep waits for it. Loop.
    virtual bool has_room() const noexcept { return true; }
    // True when the loop waits for has_room() outside lockstep as well (when_slow.h). Loop.
    virtual bool must_be_waited_for() const noexcept { return false; }
    // Takes an event; never waits. publish()'s thread reports the end of an exposure, right before that
    // frame's publish(); other events may come from any thread at the same time.
    virtual void on_event(const CameraEvent&) noexcept {}
    // Ends the threads and closes everything. Idempotent. Owner thread.
    virtual void stop() noexcept = 0;
    // Any thread.
    virtual SinkReport report() const = 0;
    // Returns the listener that wants truth for frames of this output (truth_listener.h), or null. Asked
    // before start().
    virtual TruthListener* truth_listener() noexcept { return nullptr; }
    // True when report() names a fault. Does not allocate, for callers that ask often. Any thread.
    virtual bool has_fault() const noexcept { return false; }
    // Returns what has happened since the last call. Any thread but the loop; one at a time.
    virtual std::vector<SinkNote> take_notes() { return {}; }
};

// A sink calls it when the first and the last byte of a frame have left; times are CLOCK_MONOTONIC ns. Called
// on the sink's own thread: no lock, no allocation.
class DeliveryListener {
  public:
    virtual ~DeliveryListener() = default;
    virtual void delivered(const FrameRecord& record, std::int64_t first_ns,
                           std::int64_t last_ns) noexcept = 0;
};

class CameraControl;
class CameraLines;
class FaultBoard;
class FrameFates;
class LightPartSource;

// The means that a sink gets to work with. Everything here outlives the sink.
struct SinkContext {
    CameraControl& camera;
    FaultBoard& faults;
    DeliveryListener* listener = nullptr;    // may be null
    FrameFates* fates = nullptr;             // takes the fate of frames' files; may be null
    LightPartSource* light_parts = nullptr;  // renders single parts of a frame's light; may be null
    CameraLines* lines = nullptr;            // the camera's lines; may be null
};

}  // namespace hilcam
