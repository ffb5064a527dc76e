#pragma once
// Decoded commands: everything that a sender can ask of the camera. ccsds.h knows their bytes, commands_udp.h
// one of their transports.

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>

#include "io/contract/fault.h"
#include "render/vocabulary/pose.h"

namespace hilcam {

// Sets the pose of an object: 0 is the camera, 1, 2, ... are the scenario's objects in order.
struct PoseCommand {
    std::uint16_t object = 0;
    // motion.time: the simulated TAI instant at which the pose holds; ns = 0: on arrival.
    Motion motion;
    // Forgets everything known of the object's motion before this pose. Not on the wire; for simulators that
    // send the whole world with each frame.
    bool alone = false;
};
// Sets the angle of an object's joint. Objects and joints are numbered from 1, in the scenario's order.
struct JointCommand {
    std::uint16_t object = 0;
    std::uint16_t joint = 0;
    TimeTai time;  // ns = 0: on arrival
    double angle_rad = 0;
    double rate_rad_s = 0;  // rate from `time` on
};
struct SettingsCommand {
    std::optional<double> exposure_s;
    std::optional<double> gain_db;
    std::optional<double> frame_rate_hz;
};
// A pulse on the camera's trigger wire (Line0), for a frame or a burst. In lockstep each pulse makes a frame.
struct ExposeCommand {
    // Lockstep: simulated TAI of the middle of the exposure, later than the previous frame's; ns = 0: one
    // frame period after it. Triggered: when the trigger comes; ns = 0: on arrival.
    TimeTai time;
    std::uint16_t frames = 0;  // 0: the settings' burst_frames
    // Lockstep: the time may also equal or precede the previous frame's. Not on the wire, as
    // PoseCommand::alone.
    bool at_any_time = false;
};
struct FaultCommand {
    FaultOrder order;
    bool clear_all = false;  // clears every fault; `order` is ignored
};
// Switches frame reports and housekeeping to the command's sender on or off.
struct SubscribeCommand {
    bool frame_reports = false;
    bool housekeeping = false;
};
struct TriggerModeCommand {
    bool triggered = false;
    std::uint16_t burst_frames = 0;  // 0: unchanged
};
struct StartCommand {};
struct StopCommand {};
// The acknowledgement carries the simulated time, from which a sender can set its time tags.
struct PingCommand {
    std::uint64_t token = 0;
};
// Controls how simulated time runs. Whatever the action, the answer is also one half of an exchange of clock
// readings (clock_filter.h).
struct ClockCommand {
    enum class Action : std::uint8_t {
        kAsk = 0,
        // `scale` simulated seconds per second of the machine, at once or, while time stands, from when it
        // resumes.
        kScale = 1,
        kPause = 2,   // simulated time stops
        kResume = 3,  // simulated time runs again
        kStep = 4,    // runs for step_ns and stops; only while time stands or during such a step
    } action = Action::kAsk;
    std::int64_t sender_ns = 0;  // the sender's own clock with any epoch; returned unchanged
    double scale = 1;
    std::int64_t step_ns = 0;
};
// Sets the brightness of a lamp from an instant on, until the next such command.
struct LampCommand {
    std::uint16_t lamp = 0;  // numbered from 1, in the scenario's order
    TimeTai time;            // ns = 0: on arrival
    double level = 0;        // 0: off; 1: as in its data sheet
};
inline constexpr double kMinClockScale = 1e-3, kMaxClockScale = 1e3;
inline constexpr std::int64_t kMaxClockStep_ns = 10'000'000'000'000'000;  // 116 days

// The order is that of the function codes.
using Command = std::variant<PoseCommand, SettingsCommand, StartCommand, StopCommand, PingCommand,
                             JointCommand, FaultCommand, ExposeCommand, TriggerModeCommand, SubscribeCommand,
                             ClockCommand, LampCommand>;
inline constexpr std::uint8_t kClockFunction = 11;

// The emulator's half of the exchange: when a packet came and when its answer left, in simulated time and on
// CLOCK_MONOTONIC, and the relation of the two clocks from then on:
//    simulated = min(departure + scale (monotonic - departure_monotonic), stands_at)
struct ClockReading {
    TimeTai arrival, departure;
    std::int64_t arrival_monotonic_ns = 0, departure_monotonic_ns = 0;
    double scale = 1;  // rate while time runs; kept while it stands
    // Instant at which time will stop, as far as is known; the largest value: it does not stop.
    TimeTai stands_at{std::numeric_limits<std::int64_t>::max()};
};

// The result of a command, sent in its acknowledgement. The numbers are part of the protocol.
enum class CommandStatus : std::uint8_t {
    kAccepted = 0,
    kBadLength = 1,  // a datagram or packet is shorter or longer than its header says
    kBadHeader = 2,  // wrong version, type, secondary header flag or sequence flags
    kUnknownApid = 3,
    kBadChecksum = 4,
    kUnknownFunction = 5,
    kBadArgument = 6,  // not finite, no unit quaternion, or outside its limits
    kUnknownObject = 7,
    kTimeOutOfRange = 8,  // the time tag is further than commands.poses.horizon_s from simulated time
    kBusy = 9,            // the trigger came too early, or too many frames wait: try again later
    kNotNow = 10,         // not possible in the camera's mode or the clock's state
    kTimeBackwards = 11,  // the time tag precedes the newest of its thing, and the scenario refuses that
};

// Remarks about a command, also about a refused one.
struct CommandNotes {
    bool went_back = false;      // the time tag precedes the newest of its thing: the sender's clock is wrong
    bool notify_sender = false;  // put went_back into the acknowledgement
    std::uint16_t refused_by = 0;  // first camera to refuse, from 1, of those that were asked; 0: none
    std::string why{};  // that camera's reason; replaces the general text of the status (command_station.cpp)
};

// The origin of a command.
struct CommandSource {
    std::uint32_t sequence = 0;
    std::int64_t arrival_monotonic_ns = 0;
    std::uint16_t camera = 0;       // camera it is for, from 1; 0: all. Poses, angles and lamps are for all.
    CommandNotes* notes = nullptr;  // filled by the handler, also on refusal; may be null
    std::uint16_t event = 0;  // number of the scenario's event that gave it, from 1; 0: a sender gave it
    TimeTai due{};            // the event's simulated time, from which its settings hold; ns = 0: on arrival
};

// Carries out decoded commands; implemented by the emulator. Receivers call it from their threads, one
// command at a time per receiver.
class CommandHandler {
  public:
    virtual ~CommandHandler() = default;
    virtual CommandStatus handle(const Command& command, const CommandSource& source) = 0;
    // Returns simulated time.
    virtual TimeTai now() const = 0;
    // Returns the clock's reading for the answer to a ClockCommand that arrived at that time.
    virtual ClockReading read_clock(std::int64_t arrival_monotonic_ns) const {
        ClockReading reading;
        reading.arrival = reading.departure = now();
        reading.arrival_monotonic_ns = reading.departure_monotonic_ns = arrival_monotonic_ns;
        return reading;
    }
};

// Counters of one receiver, or their sums.
struct CommandReport {
    std::uint64_t received = 0;
    std::uint64_t refused = 0;
    std::uint64_t lost = 0;           // gaps in the senders' sequence numbers, less packets that came late
    std::uint64_t duplicates = 0;     // packets with a sequence number that had already come
    std::uint64_t went_back = 0;      // poses and angles with a time tag before the newest
    std::uint64_t skipped_bytes = 0;  // bytes of streams outside packets
    std::uint64_t strangers = 0;      // connections and datagrams from senders that are not allowed
    std::uint64_t cut_off = 0;        // clients cut off because they did not read their answers
    std::uint64_t clients = 0;        // connected at present; over UDP: heard within the last minute

    CommandReport& operator+=(const CommandReport& other) {
        received += other.received, refused += other.refused, lost += other.lost;
        duplicates += other.duplicates, went_back += other.went_back;
        skipped_bytes += other.skipped_bytes, strangers += other.strangers, cut_off += other.cut_off,
            clients += other.clients;
        return *this;
    }
};

// Counters of one sender.
struct SenderReport {
    std::string name;  // "127.0.0.1:40312"
    std::uint64_t received = 0, refused = 0, lost = 0, duplicates = 0, went_back = 0;
    SubscribeCommand subscription;
};

}  // namespace hilcam
