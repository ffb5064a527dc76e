#pragma once
// The contents of a recording (docs/recording.md): all that a run's frames depend on beside the scenario.
// Everything except the header is plain data, so that it can pass through a queue without a lock.
//
// Commands are numbered in the order in which they take effect. Before a frame, the recording has the number
// of the newest command that the frame shows of each thing (RecordedShown), if it has changed since the
// previous frame. From this a replay knows what had arrived when the frame was made, however the threads ran.

#include <cstdint>
#include <string>
#include <type_traits>
#include <variant>

#include "emulator/loop/frame_script.h"
#include "io/contract/camera_control.h"
#include "io/contract/command.h"

namespace hilcam {

struct RecordingHeader {
    std::string program;      // "hilcam 0.3.0"
    std::uint32_t build = 0;  // CRC-32 of the program file
    std::string processor;
    TimeTai start;  // in simulated time
    std::int64_t monotonic_start_ns = 0;
    std::uint16_t cameras = 1;
    bool lockstep = false;
    std::string scenario;  // scenario_listing.h
};

// An accepted command. Poses, joints and lamps have the time tags that they were given on arrival.
struct RecordedCommand {
    std::uint64_t number = 0;  // from 1
    Command command;
    CommandSource source;
    bool forgets = false;  // true: earlier knowledge of the pose, joint or lamp is discarded
};
// A change of a camera's settings, by a command or by a client of the camera.
struct RecordedChange {
    std::uint16_t camera = 0;  // from 1
    std::int64_t monotonic_ns = 0;
    SettingsChange change;
};
// A trigger of a camera.
struct RecordedTrigger {
    std::uint16_t camera = 0;
    std::int64_t monotonic_ns = 0;
    TriggerOrder order;
    TriggerResult result = TriggerResult::kTaken;
};
// The camera's next frame shows this command of the thing (WorldState::things) as its newest.
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
// This many records are missing here, because the disk was too slow.
struct RecordedLoss {
    std::uint64_t records = 0;
};
// The end of the run. A recording without it was cut off.
struct RecordedEnd {
    std::int64_t monotonic_ns = 0;
};

using Record = std::variant<RecordedCommand, RecordedChange, RecordedTrigger, RecordedShown, RecordedFrame,
                            RecordedLoss, RecordedEnd>;
static_assert(std::is_trivially_copyable_v<Record>);

}  // namespace hilcam
