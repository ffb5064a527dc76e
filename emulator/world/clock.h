#pragma once
// Simulated time, the machine's clock, and the camera's time between the two. All are int64 ns.
//
//     machine     CLOCK_MONOTONIC
//     camera      counts frame periods, exposures, shutters and trigger delays, because the camera belongs to
//                 the simulated world. It runs `scale` times as fast as the machine's time.
//     simulated   TAI of the world. Runs with the camera's time, or stands still.
//
// A bench with a machine or simulator that is too slow can run at scale 0.1. It gets the frames that it would
// get in real time, with the same instants and the same blur; receivers see them ten times as far apart.
//
// While simulated time stands still (paused, or after a step), camera_in_pause decides:
//     streams     the camera's time goes on. Frames of the unmoving world, without blur, keep coming at their
//                 rate, so that flight software sees a working camera. Frame ids count frames, not simulated
//                 time.
//     waits       the camera's time stands still, too. No frame begins; a frame with an exposure that has
//                 begun is handed over after time has gone on to its end.
// A step lets time run, at the present scale, for exactly its length; every frame that begins meanwhile is
// taken.
//
// A change takes effect kLead_ns after it was ordered, when every thread knows it. So each instant of the
// machine has exactly one simulated time, whichever thread asks and whenever. Simulated time never jumps and
// never runs backwards.
//
//     camera    = min(c0 + scale (machine - m0), c_most)      one piece, from m0, c0 on
//     simulated = clamp(camera + shift, s_least, s_most)
// Example: from m0 = 5 s at scale 0.5, c0 = 3 s, shift = 100 s: 7 s of the machine are 4 s of the camera and
// 104 s of simulated time. Scaled times are rounded to 1 ns; at scale 1 they are exact.
//
// Lockstep: simulated time stands still until a step is ordered, `now` is the time of the last frame, the
// scale has no meaning, and changes are refused. The other two time axes run as usual, and only name
// instants.
//
// Threads: any, without a lock, except order(), which takes one and returns when the change is in effect.

#include <atomic>
#include <cstdint>
#include <limits>
#include <mutex>

#include "io/contract/command.h"
#include "io/system/monotonic.h"
#include "render/vocabulary/config_field.h"
#include "render/vocabulary/shared_latest.h"
#include "render/vocabulary/time.h"

namespace hilcam {

enum class CameraInPause : std::uint8_t { kStreams, kWaits };
struct ClockConfig {
    double scale = 1;
    bool paused = false;  // initial state
    CameraInPause camera_in_pause = CameraInPause::kStreams;
};
Fields fields(ClockConfig& clock);
// Throws InputError for settings without meaning in lockstep, where simulated time steps from frame to frame.
void require_lockstep(const ClockConfig& clock);

class SimulatedClock {
  public:
    static constexpr std::int64_t kNever_ns = std::numeric_limits<std::int64_t>::max();
    static constexpr std::int64_t kLead_ns = 1'000'000;

    SimulatedClock(TimeTai start, std::int64_t monotonic_start_ns, bool lockstep = false,
                   const ClockConfig& config = {});
    // Resets the clock at the begin of the run. Call before other threads use it.
    void restart(TimeTai start, std::int64_t monotonic_start_ns);

    TimeTai start() const { return start_; }
    bool lockstep() const { return lockstep_; }

    // --- from the machine's time
    std::int64_t camera_at(std::int64_t monotonic_ns) const;
    TimeTai at(std::int64_t monotonic_ns) const;
    // Returns what "now" means in a message with that arrival: at(), or in lockstep the last frame's time.
    TimeTai of_arrival(std::int64_t arrival_ns) const {
        return lockstep_ ? TimeTai{stepped_ns_.load()} : at(arrival_ns);
    }
    TimeTai now() const { return of_arrival(monotonic_ns()); }
    // Returns a reading for a sender that synchronises its own clock.
    ClockReading read(std::int64_t arrival_monotonic_ns) const;

    // --- from the camera's time
    TimeTai simulated_of_camera(std::int64_t camera_ns) const;
    // Returns the machine's time, as if nothing stopped the camera.
    std::int64_t monotonic_of_camera(std::int64_t camera_ns) const;
    // Returns when the camera's time gets there as the clock runs now; kNever_ns while it waits.
    std::int64_t when_due(std::int64_t camera_ns) const;

    // --- from simulated time
    // Returns when simulated time gets there as the clock runs now; kNever_ns if it stands still before.
    std::int64_t camera_of(TimeTai simulated) const;

    // Carries out a `clock` command. Returns kNotNow in lockstep, and for a step while time runs.
    CommandStatus order(const ClockCommand& command);
    // Lockstep: moves simulated time to the next frame.
    void step_to(TimeTai time) { stepped_ns_.store(time.ns); }

  private:
    struct Piece {
        std::int64_t monotonic_ns, camera_ns;
        double scale;
        std::int64_t shift_ns, min_ns, max_ns, camera_most_ns;

        std::int64_t camera_at(std::int64_t monotonic) const;
        std::int64_t simulated_of(std::int64_t camera) const;
        std::int64_t monotonic_of(std::int64_t camera) const;
    };
    struct State {
        Piece before, now;
        double scale;  // in force, or to be in force when time goes on
        // Simulated time at which the clock stands or will stand; kNever_ns: it runs on.
        std::int64_t stand_ns;

        const Piece& at(std::int64_t monotonic) const { return monotonic < now.monotonic_ns ? before : now; }
        const Piece& of(std::int64_t camera) const { return camera < now.camera_ns ? before : now; }
    };
    struct Beginning {
        std::int64_t monotonic_ns, camera_ns, simulated_ns, min_ns;
    };
    Piece piece_from(const Beginning& from, double scale, std::int64_t stand_ns) const;
    State first_state(std::int64_t monotonic_start_ns) const;

    TimeTai start_;
    bool lockstep_;
    ClockConfig config_;
    std::mutex writers_;
    SharedLatest<State> state_;
    std::atomic<std::int64_t> stepped_ns_;
};

}  // namespace hilcam
