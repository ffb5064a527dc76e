#pragma once
// A recording's frames once more, through the same loop: bit by bit the same on the same build and kind of
// machine, on any number of threads.
//
// A thread of the replay's own reads the file, gives the world the commands that the next frame shows, hands
// the frame's use to the loop and waits until the loop has seen that world: so nothing of the loop waits for
// a file. Commands from outside do not exist in a replay; what a client sets has no effect.
//
// Memory does not grow with the recording: it is read twice, by a reader that looks for the camera's next
// frame and one that follows with the commands.

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

// Refuses a recording that is of another program or scenario, in one line that names both, unless `force`.
// Gives what may change bits all the same (another build, another processor) and what was forced, a line
// each. scenario: scenario_listing(). Throws InputError.
std::vector<std::string> check_recording(const RecordingHeader& recording, const std::string& name,
                                         const RecordingHeader& own, bool force);

// The parts of a camera that a replay needs; all of it outlives the replay.
struct ReplayedCamera {
    std::uint16_t number = 1;
    WorldState* world = nullptr;
    FaultBoard* faults = nullptr;
    CameraLimits limits;
    CameraSettings power_up;  // settings with which it begins
    std::size_t levels = 1;   // levels of quality
};

class Replay : public FrameScript {
  public:
    // Throws InputError when the file cannot be read. fast: as fast as it goes, else by the times of the
    // recording (never those of lockstep).
    Replay(const std::filesystem::path& file, const ReplayedCamera& camera, bool fast);
    ~Replay() override { stop(); }

    // monotonic_start_ns: of this run, where the recording's was when it was made.
    void start(std::int64_t monotonic_start_ns);
    void stop() noexcept;

    bool next(const std::atomic<bool>& stopping, FrameUse& use, std::int64_t& not_before_ns) override;
    void seen() noexcept override { seen_.release(); }

    struct Outcome {
        bool whole = false;  // all frames of the run were there
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
    std::vector<std::uint64_t> shown_;  // by thing: the newest command of the next frame
    std::vector<Pending> pending_;      // read, but not shown yet

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
