#pragma once
// Replays a recording's frames through the same loop: bit by bit the same on the same build and kind of
// machine, with any number of threads.
//
// The replay's own thread reads the file, gives the world the commands that the next frame shows, hands the
// frame's use to the loop, and waits until the loop has sampled that world. So the loop never waits for a
// file. A replay ignores commands from outside and settings from clients.
//
// Memory does not grow with the recording. It is read twice: one reader looks ahead for the camera's next
// frame, the other follows with the commands.

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "emulator/loop/frame_script.h"
#include "emulator/recording/recording_reader.h"
#include "emulator/world/world_state.h"
#include "io/contract/camera_control.h"
#include "io/contract/fault.h"
#include "io/system/timed_semaphore.h"

namespace hilcam {

// Refuses a recording of another program or scenario, in one line that names both, unless `force` is set.
// Returns what may still change bits (another build, another processor) and what was forced, one line each.
// scenario: scenario_listing(). Throws InputError.
std::vector<std::string> check_recording(const RecordingHeader& recording, const std::string& name,
                                         const RecordingHeader& own, bool force);

// The parts of a camera that a replay uses. All must outlive the replay.
struct ReplayedCamera {
    std::uint16_t number = 1;
    WorldState* world = nullptr;
    FaultBoard* faults = nullptr;
    CameraLimits limits;
    CameraSettings power_up;  // settings at the begin
    std::size_t levels = 1;   // number of quality levels
};

class Replay : public FrameScript {
  public:
    // fast: as fast as possible; otherwise at the recording's times, which recordings of lockstep runs
    // ignore. Throws InputError when the file cannot be read.
    Replay(const std::filesystem::path& file, const ReplayedCamera& camera, bool fast);
    ~Replay() override { stop(); }

    // monotonic_start_ns: this run's start, which corresponds to the start in the recording.
    void start(std::int64_t monotonic_start_ns);
    void stop() noexcept;

    bool next(const std::atomic<bool>& stopping, FrameUse& use, std::int64_t& not_before_ns) override;
    void seen() noexcept override { seen_.release(); }

    struct Outcome {
        bool whole = false;  // all frames of the run were in the recording
        std::uint64_t frames = 0;
        std::string text;  // where it ended; empty while it runs
    };
    Outcome outcome() const;

  private:
    struct Pending {
        std::size_t thing;
        RecordedCommand command;
    };

    void run();
    bool find_frame(FrameUse& use);
    void apply_commands();
    void apply(const Pending& pending);
    std::optional<std::size_t> thing_of(const Command& command) const;
    std::string refusal_of(const FrameUse& use) const;
    bool offer(const FrameUse& use);
    void end(bool whole, std::string text);

    ReplayedCamera camera_;
    RecordingReader frames_, commands_;
    bool paced_;
    std::int64_t shift_ns_ = 0;  // from the recording's clock to this run's
    std::uint64_t last_id_ = 0;
    std::vector<std::uint64_t> shown_;  // by thing: newest command that the next frame shows
    std::vector<Pending> pending_;      // read, but not yet shown

    // Hand-over to the loop.
    FrameUse use_;
    std::int64_t not_before_ns_ = 0;
    bool ended_ = false;
    TimedSemaphore offered_, seen_;

    mutable std::mutex mutex_;
    Outcome outcome_;
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace hilcam
