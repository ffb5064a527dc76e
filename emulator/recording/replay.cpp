#include "emulator/recording/replay.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "emulator/scenario/scenario_listing.h"
#include "io/system/monotonic.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/overloaded.h"

namespace hilcam {
namespace {

constexpr std::int64_t kPatience_ns = 50'000'000;  // longest time that a stop has to wait
constexpr std::int64_t kStopsWithin_ns = 50'000'000;

bool binning_fits(std::int64_t binning, std::int64_t at_power_up, std::int64_t most) {
    return binning == at_power_up || (binning >= 1 && binning <= most && (binning & (binning - 1)) == 0);
}

template <class C>
concept MovesNothing = OneOf<C, SettingsCommand, StartCommand, StopCommand, PingCommand, FaultCommand,
                             ExposeCommand, TriggerModeCommand, SubscribeCommand, ClockCommand>;

bool is_fraction(const std::optional<double>& value) { return !value || (*value >= 0 && *value <= 1); }

}  // namespace

std::vector<std::string> check_recording(const RecordingHeader& there, const std::string& name,
                                         const RecordingHeader& here, bool force) {
    std::vector<std::string> warnings;
    const auto refuse = [&](const std::string& what) {
        if (!force) throw InputError(name + ": " + what + "; --force replays it anyway");
        warnings.push_back(name + ": " + what + ": frames may differ");
    };
    if (there.program != here.program)
        refuse("was recorded by '" + there.program + "', this is '" + here.program + "'");
    const std::string difference = listing_difference(there.scenario, here.scenario);
    if (!difference.empty()) refuse("was recorded with another scenario: " + difference);
    if (there.cameras != here.cameras)
        refuse("was recorded with " + std::to_string(there.cameras) + " cameras, here are " +
               std::to_string(here.cameras));
    if (there.program == here.program && there.build != here.build)
        warnings.push_back(name + ": was recorded by another build of '" + here.program +
                           "': single bits may differ");
    if (there.processor != here.processor)
        warnings.push_back(name + ": was recorded on '" + there.processor + "', this is '" + here.processor +
                           "': single bits may differ");
    return warnings;
}

Replay::Replay(const std::filesystem::path& file, const ReplayedCamera& camera, bool fast)
    : camera_(camera),
      frames_(file),
      commands_(file),
      paced_(!fast && !frames_.header().lockstep),
      shown_(camera.world->things()) {}

void Replay::start(std::int64_t monotonic_start_ns) {
    // Both are times since a machine was started, possibly another machine.
    shift_ns_ = monotonic_start_ns - frames_.header().monotonic_start_ns;
    thread_ = std::thread([this] { run(); });
}

void Replay::stop() noexcept {
    stopping_.store(true);
    if (thread_.joinable()) thread_.join();
}

// --- called by the loop

bool Replay::next(const std::atomic<bool>& stopping, FrameUse& use, std::int64_t& not_before_ns) {
    while (!stopping.load(std::memory_order_relaxed)) {
        if (!offered_.try_acquire_for(kPatience_ns)) continue;
        if (ended_) return false;
        use = use_;
        not_before_ns = not_before_ns_;
        return true;
    }
    return false;
}

// --- called by the replay's thread

void Replay::run() {
    FrameUse use;
    while (find_frame(use)) {
        apply_commands();
        const std::string refusal = refusal_of(use);
        if (!refusal.empty()) {
            end(false, frames_.name() + ": frame " + std::to_string(use.id) + ": " + refusal);
            break;
        }
        last_id_ = use.id;
        if (!offer(use)) return;
        const std::lock_guard lock(mutex_);
        ++outcome_.frames;
    }
    if (frames_.end() != RecordingEnd::kNone) end(frames_.end() == RecordingEnd::kClean, frames_.end_text());
    ended_ = true;
    offered_.release();
}

void Replay::end(bool whole, std::string text) {
    const std::lock_guard lock(mutex_);
    outcome_.whole = whole;
    outcome_.text = std::move(text);
}

Replay::Outcome Replay::outcome() const {
    const std::lock_guard lock(mutex_);
    return outcome_;
}

// Finds the camera's next frame and the commands that it shows.
bool Replay::find_frame(FrameUse& use) {
    Record record;
    while (!stopping_.load(std::memory_order_relaxed) && frames_.next(record)) {
        if (const auto* shown = std::get_if<RecordedShown>(&record)) {
            if (shown->camera == camera_.number && shown->thing < shown_.size())
                shown_[shown->thing] = shown->number;
        } else if (const auto* frame = std::get_if<RecordedFrame>(&record)) {
            if (frame->camera != camera_.number) continue;
            use = frame->use;
            return true;
        }
    }
    return false;
}

// Applies the commands that the frame shows. All commands up to the frame have been read; those that came too
// late for it wait for a later frame.
void Replay::apply_commands() {
    Record record;
    while (commands_.offset() < frames_.offset() && commands_.next(record)) {
        const auto* recorded = std::get_if<RecordedCommand>(&record);
        if (!recorded) continue;
        if (const auto thing = thing_of(recorded->command)) {
            pending_.push_back({*thing, *recorded});
        } else if (const auto* fault = std::get_if<FaultCommand>(&recorded->command)) {
            const std::uint16_t meant = recorded->source.camera;
            if (meant != 0 && meant != camera_.number) continue;
            fault->clear_all ? camera_.faults->clear_all() : camera_.faults->order(fault->order);
        }
    }
    std::vector<Pending> later;
    for (const Pending& pending : pending_) {
        if (pending.command.number <= shown_[pending.thing])
            apply(pending);
        else
            later.push_back(pending);
    }
    pending_ = std::move(later);
}

// Returns the thing that a command moves. apply_commands() orders faults at once; the effect of other
// commands is contained in the frames' own use, with which they are made again.
std::optional<std::size_t> Replay::thing_of(const Command& command) const {
    using Thing = std::optional<std::size_t>;
    const WorldState& world = *camera_.world;
    return std::visit(
        Overloaded{
            [&](const PoseCommand& pose) { return Thing(world.thing_of(pose.object)); },
            [&](const JointCommand& joint) { return Thing(world.thing_of(joint.object, joint.joint)); },
            [&](const LampCommand& lamp) { return Thing(world.thing_of_lamp(lamp.lamp)); },
            [](const MovesNothing auto&) { return Thing(); },
        },
        command);
}

void Replay::apply(const Pending& pending) {
    const RecordedCommand& c = pending.command;
    const ShownCommand shown{c.source.sequence, c.source.arrival_monotonic_ns, {}, c.number};
    WorldState& world = *camera_.world;
    std::visit(Overloaded{
                   [&](const PoseCommand& pose) { world.set(pose.object, pose.motion, shown, c.forgets); },
                   [&](const JointCommand& joint) {
                       world.set_joint(joint.object, joint.joint,
                                       {joint.time, joint.angle_rad, joint.rate_rad_s}, shown, c.forgets);
                   },
                   [&](const LampCommand& lamp) {
                       world.set_lamp(lamp.lamp, {lamp.time, lamp.level}, shown, c.forgets);
                   },
                   [](const MovesNothing auto&) {},
               },
               c.command);
}

// Returns why a frame must not be given to the loop, or an empty text. CRCs detect damage, but not a forged
// file.
std::string Replay::refusal_of(const FrameUse& use) const {
    const CameraSettings& own = camera_.power_up;
    constexpr std::int64_t kFarthest_ns = 4'000'000'000'000'000'000;  // sums with it do not overflow
    for (const std::int64_t ns :
         {use.begin_ns, use.middle_ns, use.end_ns, use.exposure_mid.ns / 2, use.shown_at.ns / 2})
        if (ns < -kFarthest_ns || ns > kFarthest_ns) return "its time cannot be";
    if (!(use.moving >= 0 && use.moving <= 1)) return "the motion is longer than the exposure";
    if (use.id <= last_id_) return "its number is not after that of the frame before";
    if (!(use.exposure_s > 0 && use.exposure_s <= 1e5)) return "its exposure is not 0 to 1e5 s";
    if (!(std::abs(use.gain_db) <= 200)) return "its gain is not -200 to 200 dB";
    if (!(use.black_level_dn >= 0 && use.black_level_dn <= 65535)) return "its black level is not 0 to 65535";
    if (!binning_fits(use.binning_x, own.binning_x, camera_.limits.max_binning) ||
        !binning_fits(use.binning_y, own.binning_y, camera_.limits.max_binning))
        return "its binning is not one of the camera";
    if (use.quality_level >= camera_.levels) return "its quality level does not exist";
    if (!is_fraction(use.image.tear_share) || !is_fraction(use.image.flip_rate))
        return "its faults cannot be";
    return {};
}

// Hands over a frame and waits until the loop has sampled the world for it; false when the replay is stopped.
bool Replay::offer(const FrameUse& use) {
    use_ = use;
    for (std::int64_t* const ns : {&use_.begin_ns, &use_.middle_ns, &use_.end_ns}) *ns += shift_ns_;
    not_before_ns_ = 0;
    if (paced_) {
        not_before_ns_ = use_.end_ns;
        for (std::int64_t now_ns = monotonic_ns(); now_ns < use_.begin_ns; now_ns = monotonic_ns()) {
            if (stopping_.load()) return false;
            sleep_until_monotonic_ns(std::min(use_.begin_ns, now_ns + kStopsWithin_ns));
        }
    }
    offered_.release();
    while (!seen_.try_acquire_for(kPatience_ns))
        if (stopping_.load()) return false;
    return true;
}

}  // namespace hilcam
