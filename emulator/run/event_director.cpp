#include "emulator/run/event_director.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "io/commands/acknowledgement.h"
#include "render/vocabulary/overloaded.h"
#include "render/vocabulary/time.h"

namespace hilcam {
namespace {

// Events are evaluated this long before a frame's begin: within the last stretch, in which the loop handles
// nothing else (frame_starter.cpp), so that a new frame rate cannot move that begin.
constexpr std::int64_t kLead_ns = 900'000;
constexpr std::int64_t kLongestWait_ns = 50'000'000;  // longest time that a stop has to wait

}  // namespace

EventDirector::EventDirector(EventSequence sequence, const Bench& bench)
    : sequence_(std::move(sequence)),
      bench_(bench),
      seen_(nothing_seen(bench.placed_objects)),
      newest_(seen_) {}

EventDirector::Seen EventDirector::nothing_seen(std::size_t placed_objects) {
    Seen nothing;
    nothing.world.objects.resize(placed_objects);
    return nothing;
}

void EventDirector::start() {
    if (bench_.clock.lockstep()) {
        if (bench_.self_driven) thread_ = std::thread([this] { drive(); });
        return;
    }
    happen_until(bench_.clock.now());
    thread_ = std::thread([this] { run(); });
}

void EventDirector::stop() noexcept {
    stopping_.store(true);
    news_.release();
    if (thread_.joinable()) thread_.join();
}

// Copies into existing memory, because the world's number of objects does not change.
void EventDirector::seen(const SeenFrame& frame, const WorldSnapshot& world) noexcept {
    seen_.frame = frame;
    seen_.world = world;
    newest_.write(seen_);
    if (!bench_.clock.lockstep()) news_.release();  // in lockstep nothing waits for it
}

void EventDirector::look() {
    const Seen& newest = newest_.read();
    if (newest.frame.id == frame_.id) return;
    frame_ = newest.frame;
    sequence_.saw(frame_, newest.world);
}

// --- lockstep

void EventDirector::before_frame(const TriggerOrder& order) {
    look();
    happen_until(begin_of(order));
    const double exposure_s = bench_.settings.settings().exposure_s;
    switch_lamps_until(begin_of(order) + to_ns(bench_.timing.end_s(exposure_s)));
}

// Returns the begin as the frame starter computes it, with the previous frame's exposure if the camera sets
// that itself.
TimeTai EventDirector::begin_of(const TriggerOrder& order) const {
    const CameraSettings s = bench_.settings.settings();
    const std::int64_t to_middle_ns = to_ns(bench_.timing.middle_s(s.exposure_s));
    if (order.at_simulated.ns != 0) return order.at_simulated + -to_middle_ns;
    if (frame_.id == 0) return bench_.clock.start();
    return frame_.middle + (to_ns(bench_.timing.period_s(s.frame_rate_hz, s.exposure_s)) - to_middle_ns);
}

// Takes picture after picture, because no sender orders frames; then carries out events that no frame
// follows, and ends the run.
void EventDirector::drive() {
    for (bool more = true; more && !picture_refused_;) {
        look();
        std::optional<TimeTai> until = sequence_.next_time(true);
        if (!until && sequence_.comes_to_something()) until = sequence_.next_time();
        more = happen_until(until.value_or(bench_.clock.start()));
    }
    if (asks_to_end() || stopping_.load()) return;
    if (picture_refused_)
        spdlog::warn("the camera takes no more pictures: an event has ended the run");
    else
        spdlog::info("no event is left that takes a picture: the run ends");
    asks_to_end_.store(true);
}

// --- free-run, triggered

void EventDirector::run() {
    while (!stopping_.load()) {
        const std::int64_t now_ns = monotonic_ns(), until_ns = wait_until_ns();
        static_cast<void>(news_.try_acquire_until(std::min(until_ns, now_ns + kLongestWait_ns)));
        news_.take_all();
        look();
        happen_until(horizon());
    }
}

// Returns when the frame after the last seen one begins, if nothing changes.
EventDirector::NextBegin EventDirector::next_begin() const {
    if (frame_.id == 0) return {};
    const SimulatedClock& clock = bench_.clock;
    const CameraSettings s = bench_.settings.settings();
    const std::int64_t camera_ns =
        clock.camera_at(frame_.begin_ns) + to_ns(bench_.timing.period_s(s.frame_rate_hz, s.exposure_s));
    return {clock.when_due(camera_ns), clock.simulated_of_camera(camera_ns)};
}

// Returns the time of the next event with a known time: never while simulated time stands still before it.
std::int64_t EventDirector::wait_until_ns() const {
    const std::optional<TimeTai> due = sequence_.next_time();
    const std::int64_t camera_ns = due ? bench_.clock.camera_of(*due) : SimulatedClock::kNever_ns;
    if (camera_ns == SimulatedClock::kNever_ns) return camera_ns;
    const std::int64_t due_ns = bench_.clock.when_due(camera_ns), begin_ns = next_begin().monotonic_ns;
    return due_ns > begin_ns - kLead_ns && due_ns <= begin_ns ? begin_ns - kLead_ns : due_ns;
}

// Shortly before a frame begins, everything that is due at its begin counts as due.
TimeTai EventDirector::horizon() const {
    const std::int64_t now_ns = monotonic_ns();
    const TimeTai now = bench_.clock.at(now_ns);
    const NextBegin next = next_begin();
    const bool soon = next.monotonic_ns > now_ns && next.monotonic_ns - now_ns <= kLead_ns;
    return soon ? std::max(now, next.simulated) : now;
}

// --- what happens

// Returns false when nothing was due.
bool EventDirector::happen_until(TimeTai until) {
    bool any = false;
    while (!stopping_.load() && !asks_to_end_.load()) {
        const std::optional<EventSequence::Due> due = sequence_.take(until);
        if (!due) break;
        happen(*due);
        any = true;
    }
    return any;
}

// Stops at the first event that does something else, because events keep their order.
void EventDirector::switch_lamps_until(TimeTai until) {
    for (std::optional<TimeTai> next = sequence_.next_switch_time(); next && *next < until;
         next = sequence_.next_switch_time())
        if (!happen_until(*next)) return;
}

void EventDirector::happen(const EventSequence::Due& due) {
    const EventActions& actions = sequence_.actions(due.event);
    const EventConfig& config = sequence_.config(due.event);
    const double at_s = static_cast<double>(due.time - bench_.clock.start()) * kSecondsPerNs;
    const std::string name =
        config.name.empty() ? fmt::format("event {}", due.event) : fmt::format("event '{}'", config.name);
    const std::string words = fmt::format("{}", fmt::join(config.actions, "; "));
    spdlog::info("{} at {:.6f} s, after frame {}: {}", name, at_s, frame_.id, words);
    CommandSource source;
    source.camera = static_cast<std::uint16_t>(config.camera);
    source.event = static_cast<std::uint16_t>(std::min<std::size_t>(due.event + 1, 65535));
    source.due = due.time;
    for (const Command& command : actions.commands) {
        source.arrival_monotonic_ns = monotonic_ns();
        const CommandStatus status = bench_.commands.handle(stamped(command, due), source);
        if (status == CommandStatus::kAccepted || asks_to_end()) continue;
        spdlog::warn("{}: refused: {}", name, name_of(status));
        if (std::holds_alternative<ExposeCommand>(command)) picture_refused_ = true;
    }
    if (actions.ends_run) asks_to_end_.store(true);
}

// Fills in times that an event's command left open.
Command EventDirector::stamped(Command command, const EventSequence::Due& due) const {
    std::visit(Overloaded{
                   [&](PoseCommand& pose) {
                       if (pose.motion.time.ns == 0) pose.motion.time = due.time;
                   },
                   [&](JointCommand& joint) {
                       if (joint.time.ns == 0) joint.time = due.time;
                   },
                   [&](LampCommand& lamp) {
                       if (lamp.time.ns == 0) lamp.time = due.time;
                   },
                   // A picture caused by a frame is the next possible one.
                   [&](ExposeCommand& expose) {
                       if (expose.time.ns == 0 && due.by_clock) expose.time = due.time;
                   },
                   [](OneOf<SettingsCommand, StartCommand, StopCommand, PingCommand, FaultCommand,
                            TriggerModeCommand, SubscribeCommand, ClockCommand> auto&) {},
               },
               command);
    return command;
}

}  // namespace hilcam
