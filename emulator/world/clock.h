#pragma once
// Simulated time against the machine's clock, and the camera's time between the two. All are int64 ns.
//
//     machine     CLOCK_MONOTONIC
//     camera      what frame periods, exposures, shutters and trigger delays are counted in: the camera is
//     part
//                 of the simulated world. It goes `scale` times as fast as the machine's time.
//     simulated   TAI of the world. Goes with the camera's time, or stands.
//
// So a bench whose machine or simulator is too slow runs at scale 0.1 and gets the frames that it would get
// in real time: the same instants, the same blur, ten times as far apart for who receives them.
//
// While simulated time stands (paused, or a step is over)
//     camera_in_pause: streams   the camera's time goes on: frames keep coming at their rate, of the standing
//                                world, without blur. Flight software sees a living camera. Frame ids count
//                                frames, not simulated time.
//     camera_in_pause: waits     the camera's time stands, too: no frame begins, and one whose exposure has
//                                begun is handed over when time has gone on to its end.
// A step lets time run, at the scale in force, for exactly that long: every frame that begins in it is taken.
//
// A change takes effect kLead_ns after it was asked for, when every thread has it: each instant of the
// machine's has one simulated time, whoever asks and whenever. Simulated time never jumps and never goes
// back.
//
//     camera    = min(c0 + scale (machine - m0), c_most)      a piece from m0, c0 on
//     simulated = clamp(camera + shift, s_least, s_most)
// Example: from m0 = 5 s on at scale 0.5, c0 = 3 s, shift = 100 s: the machine's 7 s are the camera's 4 s and
// simulated 104 s.
// Scaled times are rounded to 1 ns; at scale 1 they are exact.
//
// Lockstep: simulated time stands until it is told to step, `now` is that of the last frame, no scale means
// anything, and changes are refused. The two other axes then run as if it were not so: they only name
// instants.
//
// Threads: any, without a lock, but for order(), which takes one and returns when the change is in effect.

#include <time.h>

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

inline void sleep_until_monotonic_ns(std::int64_t ns) {
    const timespec t{static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) != 0) {
    }
}

enum class CameraInPause : std::uint8_t { kStreams, kWaits };
struct ClockConfig {
    double scale = 1;
    bool paused = false;  // at the start
    CameraInPause camera_in_pause = CameraInPause::kStreams;
};
Fields fields(ClockConfig& clock);
// Throws InputError for what makes no sense in lockstep, where simulated time goes from frame to frame.
void require_lockstep(const ClockConfig& clock);

class SimulatedClock {
  public:
    static constexpr std::int64_t kNever_ns = std::numeric_limits<std::int64_t>::max();
    static constexpr std::int64_t kLead_ns = 1'000'000;

    SimulatedClock(TimeTai start, std::int64_t monotonic_start_ns, bool lockstep = false,
                   const ClockConfig& config = {});
    // The run begins: as made anew. Before other threads know the clock.
    void restart(TimeTai start, std::int64_t monotonic_start_ns);

    TimeTai start() const { return start_; }
    bool lockstep() const { return lockstep_; }

    // --- from the machine's time
    std::int64_t camera_at(std::int64_t monotonic_ns) const;
    TimeTai at(std::int64_t monotonic_ns) const;
    // What a message of that arrival means by "now": at(), in lockstep the last frame's time.
    TimeTai of_arrival(std::int64_t arrival_ns) const {
        return lockstep_ ? TimeTai{stepped_ns_.load()} : at(arrival_ns);
    }
    TimeTai now() const { return of_arrival(monotonic_ns()); }
    // For a sender that sets its clock by this one.
    ClockReading read(std::int64_t arrival_monotonic_ns) const;

    // --- from the camera's time
    TimeTai simulated_of_camera(std::int64_t camera_ns) const;
    // The machine's, as if nothing stopped the camera.
    std::int64_t monotonic_of_camera(std::int64_t camera_ns) const;
    // When the camera gets there as things are now: kNever_ns where it waits.
    std::int64_t when_due(std::int64_t camera_ns) const;

    // --- from simulated time
    // When the camera gets there as things are now: kNever_ns where time stands before it.
    std::int64_t camera_of(TimeTai simulated) const;

    // A `clock` command. kNotNow: in lockstep, or a step while time runs.
    CommandStatus order(const ClockCommand& command);
    // Lockstep.
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
        double scale;           // in force, or to be when time goes on
        std::int64_t stand_ns;  // simulated: where time stands or will; kNever_ns: nowhere

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
