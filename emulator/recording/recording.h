#pragma once
// The contents of a recording (docs/recording.md): all that a run's frames depend on and that a scenario does
// not say. Everything here but the header is plain data, so that it can go through a queue without a lock.
//
// Commands are numbered in the order in which they take effect. A frame is preceded by the number of the
// newest command that it shows of each thing (RecordedShown), where that has changed since the frame before:
// with it a replay knows what had arrived when the frame was made, however threads ran.

#include <cstdint>
#include <string>
#include <type_traits>
#include <variant>

#include "emulator/loop/frame_script.h"
#include "io/contract/camera_control.h"
#include "io/contract/command.h"

namespace hilcam {

struct RecordingHeader {
    std::string program;      // "hilcam 0.1.0"
    std::uint32_t build = 0;  // CRC-32 of the program's file
    std::string processor;
    TimeTai start;  // simulated
    std::int64_t monotonic_start_ns = 0;
    std::uint16_t cameras = 1;
    bool lockstep = false;
    std::string scenario;  // scenario_listing.h
};

// One that was accepted. Time tags of poses, joints and lamps are those that they were given on arrival.
struct RecordedCommand {
    std::uint64_t number = 0;  // from 1
    Command command;
    CommandSource source;
    bool forgets = false;  // true: what was known of the pose, joint or lamp before is forgotten
};
// A camera's settings have changed, by a command or by a client of the camera.
struct RecordedChange {
    std::uint16_t camera = 0;  // from 1
    std::int64_t monotonic_ns = 0;
    SettingsChange change;
};
// A camera was triggered.
struct RecordedTrigger {
    std::uint16_t camera = 0;
    std::int64_t monotonic_ns = 0;
    TriggerOrder order;
    TriggerResult result = TriggerResult::kTaken;
};
// The camera's next frame shows this command of the thing (WorldState::things) at the newest.
struct RecordedShown {
    std::uint16_t camera = 0;
    std::uint32_t thing = 0;
    std::uint64_t number = 0;
};
// A frame as it was handed to the outputs.
struct RecordedFrame {
    std::uint16_t camera = 0;
    FrameUse use;
};
// Says that so many records are missing here: the disk was too slow.
struct RecordedLoss {
    std::uint64_t records = 0;
};
// The run ended here. Without it a recording was cut off.
struct RecordedEnd {
    std::int64_t monotonic_ns = 0;
};

using Record = std::variant<RecordedCommand, RecordedChange, RecordedTrigger, RecordedShown, RecordedFrame,
                            RecordedLoss, RecordedEnd>;
static_assert(std::is_trivially_copyable_v<Record>);

}  // namespace hilcam
