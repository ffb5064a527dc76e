#include "emulator/world/clock.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"

namespace hilcam {
namespace {

constexpr std::int64_t kEver_ns = std::numeric_limits<std::int64_t>::min();
// More than a century; later times stop there instead of overflowing.
constexpr double kFarthestClock_ns = 4e18;

std::int64_t scaled(std::int64_t ns, double scale) {
    if (scale == 1) return ns;
    return std::llround(std::clamp(static_cast<double>(ns) * scale, -kFarthestClock_ns, kFarthestClock_ns));
}

}  // namespace

Fields fields(ClockConfig& c) {
    return {
        number("scale", c.scale, 1, {kMinClockScale, kMaxClockScale},
               "simulated seconds per second of real time; frame rate and exposure are in simulated time. "
               "0.1: ten times slower"),
        flag("paused", c.paused,
             "true: simulated time stands still from the start until a clock command starts it"),
        choice("camera_in_pause", c.camera_in_pause, {"streams", "waits"},
               "behaviour of the camera while simulated time stands still. streams: it sends frames of the "
               "unchanging world at its rate; waits: it starts no frames"),
    };
}

void require_lockstep(const ClockConfig& c) {
    if (c.scale < 1 || c.scale > 1)
        throw InputError("clock.scale: found " + plain(c.scale) +
                         "; accepted with 'mode: lockstep': 1, as time goes from frame to frame");
    if (c.paused)
        throw InputError(
            "clock.paused: found true; accepted with 'mode: lockstep': false, as time stands between frames "
            "anyway");
}

std::int64_t SimulatedClock::Piece::camera_at(std::int64_t monotonic) const {
    return std::min(camera_ns + scaled(monotonic - monotonic_ns, scale), camera_most_ns);
}
std::int64_t SimulatedClock::Piece::simulated_of(std::int64_t camera) const {
    return std::clamp(camera + shift_ns, min_ns, max_ns);
}
// Rounds up to the first nanosecond at which the camera's time is reached.
std::int64_t SimulatedClock::Piece::monotonic_of(std::int64_t camera) const {
    if (scale == 1) return monotonic_ns + (camera - camera_ns);
    const double ahead_ns = std::ceil(static_cast<double>(camera - camera_ns) / scale);
    return monotonic_ns +
           static_cast<std::int64_t>(std::clamp(ahead_ns, -kFarthestClock_ns, kFarthestClock_ns));
}

SimulatedClock::SimulatedClock(TimeTai start, std::int64_t monotonic_start_ns, bool lockstep,
                               const ClockConfig& config)
    : start_(start),
      lockstep_(lockstep),
      config_(lockstep ? ClockConfig{} : config),
      state_(first_state(monotonic_start_ns)),
      stepped_ns_(start.ns) {}

void SimulatedClock::restart(TimeTai start, std::int64_t monotonic_start_ns) {
    start_ = start;
    state_.write(first_state(monotonic_start_ns));
    stepped_ns_.store(start.ns);
}

SimulatedClock::Piece SimulatedClock::piece_from(const Beginning& from, double scale,
                                                 std::int64_t stand_ns) const {
    Piece piece{from.monotonic_ns, from.camera_ns, scale,    from.simulated_ns - from.camera_ns,
                from.min_ns,       kNever_ns,      kNever_ns};
    if (stand_ns == kNever_ns) return piece;
    if (config_.camera_in_pause == CameraInPause::kWaits)
        piece.camera_most_ns = stand_ns - piece.shift_ns;
    else
        piece.max_ns = stand_ns;
    return piece;
}

// The camera's time begins equal to simulated time; later they differ only by pauses. In lockstep simulated
// time may go before the start.
SimulatedClock::State SimulatedClock::first_state(std::int64_t monotonic_start_ns) const {
    const std::int64_t stand_ns = config_.paused ? start_.ns : kNever_ns;
    const Piece piece =
        piece_from({monotonic_start_ns, start_.ns, start_.ns, config_.paused ? start_.ns : kEver_ns},
                   config_.scale, stand_ns);
    return {piece, piece, config_.scale, stand_ns};
}

std::int64_t SimulatedClock::camera_at(std::int64_t monotonic_ns) const {
    return state_.read().at(monotonic_ns).camera_at(monotonic_ns);
}

TimeTai SimulatedClock::at(std::int64_t monotonic_ns) const {
    const State state = state_.read();
    const Piece& piece = state.at(monotonic_ns);
    return {piece.simulated_of(piece.camera_at(monotonic_ns))};
}

ClockReading SimulatedClock::read(std::int64_t arrival_monotonic_ns) const {
    ClockReading out;
    const State state = state_.read();
    out.arrival = of_arrival(arrival_monotonic_ns);
    out.arrival_monotonic_ns = arrival_monotonic_ns;
    out.scale = state.scale;
    out.departure_monotonic_ns = monotonic_ns();
    out.departure = of_arrival(out.departure_monotonic_ns);
    out.stands_at = lockstep_ ? out.departure : TimeTai{state.stand_ns};
    return out;
}

TimeTai SimulatedClock::simulated_of_camera(std::int64_t camera_ns) const {
    return {state_.read().of(camera_ns).simulated_of(camera_ns)};
}

std::int64_t SimulatedClock::monotonic_of_camera(std::int64_t camera_ns) const {
    return state_.read().of(camera_ns).monotonic_of(camera_ns);
}

std::int64_t SimulatedClock::when_due(std::int64_t camera_ns) const {
    if (camera_ns == kNever_ns) return kNever_ns;
    const State state = state_.read();
    const Piece& piece = state.of(camera_ns);
    return camera_ns > piece.camera_most_ns ? kNever_ns : piece.monotonic_of(camera_ns);
}

std::int64_t SimulatedClock::camera_of(TimeTai simulated) const {
    const Piece piece = state_.read().now;
    return simulated.ns > piece.max_ns ? kNever_ns : simulated.ns - piece.shift_ns;
}

CommandStatus SimulatedClock::order(const ClockCommand& c) {
    using Action = ClockCommand::Action;
    if (c.action == Action::kAsk) return CommandStatus::kAccepted;
    if (lockstep_) return CommandStatus::kNotNow;
    const std::lock_guard lock(writers_);
    const State old = state_.read();
    // A caller that asks for an earlier instant gets the old piece, now and later. This holds unless the
    // thread is stopped for longer than the lead between here and write().
    const std::int64_t from_ns = monotonic_ns() + kLead_ns;
    const Piece& running = old.at(from_ns);
    const std::int64_t camera_ns = running.camera_at(from_ns);
    const std::int64_t simulated_ns = running.simulated_of(camera_ns);
    State next = old;
    switch (c.action) {
        case Action::kScale:
            next.scale = c.scale;
            break;
        case Action::kPause:
            next.stand_ns = std::min(old.stand_ns, simulated_ns);
            break;
        case Action::kResume:
            next.stand_ns = kNever_ns;
            break;
        case Action::kStep:
            if (old.stand_ns == kNever_ns) return CommandStatus::kNotNow;
            // Steps add up, even while an earlier one is not finished.
            next.stand_ns = std::min(old.stand_ns, kNever_ns - 1 - c.step_ns) + c.step_ns;
            break;
        case Action::kAsk:
            break;
    }
    next.before = running;
    next.now = piece_from({from_ns, camera_ns, simulated_ns, simulated_ns}, next.scale, next.stand_ns);
    state_.write(next);
    sleep_until_monotonic_ns(from_ns);
    return CommandStatus::kAccepted;
}

}  // namespace hilcam
