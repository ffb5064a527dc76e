#pragma once
// Commands, decoded: what a sender can ask of the camera. Bytes are ccsds.h's business, transport
// commands_udp.h's.

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>

#include "io/contract/fault.h"
#include "render/vocabulary/pose.h"

namespace hilcam {

// Object 0 is the camera, 1, 2, ... the scenario's objects in their order.
struct PoseCommand {
    std::uint16_t object = 0;
    // motion.time: the instant the pose is true at, simulated TAI; ns = 0 means "on arrival".
    Motion motion;
    // All that was known of the object's motion before is forgotten. Not on the wire: of senders that tell
    // the whole world for each frame.
    bool alone = false;
};
// The angle of an object's turning part. object and joint: from 1, in the scenario's order.
struct JointCommand {
    std::uint16_t object = 0;
    std::uint16_t joint = 0;
    TimeTai time;  // ns = 0: on arrival
    double angle_rad = 0;
    double rate_rad_s = 0;  // from then on
};
struct SettingsCommand {
    std::optional<double> exposure_s;
    std::optional<double> gain_db;
    std::optional<double> frame_rate_hz;
};
// A frame, or a burst of them, on the camera's trigger wire (Line0). In lockstep it is what makes frames.
struct ExposeCommand {
    // Lockstep: simulated TAI of the exposure's middle, later than that of the frame before; ns = 0: a frame
    // period after it. Triggered: when the trigger comes; ns = 0: on arrival.
    TimeTai time;
    std::uint16_t frames = 0;  // 0: as the settings have it
    // Lockstep: the time may also be that of the frame before, or an earlier one. Not on the wire, as above.
    bool at_any_time = false;
};
struct FaultCommand {
    FaultOrder order;
    bool clear_all = false;  // the order is not looked at
};
// Frame reports and housekeeping to where this command came from, or no more.
struct SubscribeCommand {
    bool frame_reports = false;
    bool housekeeping = false;
};
struct TriggerModeCommand {
    bool triggered = false;
    std::uint16_t burst_frames = 0;  // 0: as it is
};
struct StartCommand {};
struct StopCommand {};
// Answered with the simulated time, so that a sender can set its time tags.
struct PingCommand {
    std::uint64_t token = 0;
};
// Says how simulated time goes on; whatever it asks for, it is also one half of an exchange of clock readings
// (clock_filter.h).
struct ClockCommand {
    enum class Action : std::uint8_t {
        kAsk = 0,
        kScale = 1,   // factor: simulated seconds in one of the machine's, now or when time goes on
        kPause = 2,   // simulated time stands
        kResume = 3,  // time goes on
        kStep = 4,    // goes on for so long; while it stands or such a step is on its way
    } action = Action::kAsk;
    std::int64_t sender_ns = 0;  // the sender's own clock, whatever its epoch; comes back
    double scale = 1;
    std::int64_t step_ns = 0;
};
// Sets how bright a lamp is from an instant on, until the next such command.
struct LampCommand {
    std::uint16_t lamp = 0;  // from 1, in the scenario's order
    TimeTai time;            // ns = 0: on arrival
    double level = 0;        // 0: off; 1: as its data sheet says
};
inline constexpr double kMinClockScale = 1e-3, kMaxClockScale = 1e3;
inline constexpr std::int64_t kMaxClockStep_ns = 10'000'000'000'000'000;  // 116 days

// The commands stand in the order of their function codes.
using Command = std::variant<PoseCommand, SettingsCommand, StartCommand, StopCommand, PingCommand,
                             JointCommand, FaultCommand, ExposeCommand, TriggerModeCommand, SubscribeCommand,
                             ClockCommand, LampCommand>;
inline constexpr std::uint8_t kClockFunction = 11;

// The other half: when a packet came and its answer went, by simulated time and by the machine's
// CLOCK_MONOTONIC, and how the two go together from then on:
//     simulated = min(departure + scale (monotonic - departure_monotonic), stands_at)
struct ClockReading {
    TimeTai arrival, departure;
    std::int64_t arrival_monotonic_ns = 0, departure_monotonic_ns = 0;
    double scale = 1;  // in force when time runs, also while it stands
    TimeTai stands_at{ // The end that is known as yet; the last instant there is: nowhere.
                      std::numeric_limits<std::int64_t>::max()};
};

// Travels in the acknowledgement; the numbers are part of the protocol.
enum class CommandStatus : std::uint8_t {
    kAccepted = 0,
    kBadLength = 1,  // datagram or packet shorter or longer than its header says
    kBadHeader = 2,  // version, type, secondary header flag or sequence flags
    kUnknownApid = 3,
    kBadChecksum = 4,
    kUnknownFunction = 5,
    kBadArgument =
        6,  // a number that is not finite, a quaternion that is not one, a value outside its limits
    kUnknownObject = 7,
    kTimeOutOfRange = 8,  // a time tag further from the simulated now than commands.poses.horizon_s
    kBusy = 9,            // the trigger came too early, or too many frames are waiting: try again later
    kNotNow = 10,         // the camera's mode, or the clock's, has no use for it
    kTimeBackwards = 11,  // a time tag before the newest of its thing, where that is to be refused
};

// The remarks about a command that was carried out, or refused.
struct CommandNotes {
    bool went_back = false;  // its time tag lies before the newest of its thing: a sender's clock is wrong
    bool notify_sender = false;    // that, in the acknowledgement
    std::uint16_t refused_by = 0;  // the first camera, from 1, to refuse what several were asked; 0: none
    std::string why{};  // that refused it, in place of what the status means in general (command_station.cpp)
};

// The source of a command that has arrived.
struct CommandSource {
    std::uint32_t sequence = 0;
    std::int64_t arrival_monotonic_ns = 0;
    std::uint16_t camera = 0;  // that it is for, from 1; 0: every one. Poses, angles and lamps are for all.
    CommandNotes* notes = nullptr;  // to be filled, also when it is refused; may be null
    std::uint16_t event = 0;        // event of the scenario that gave it, from 1; 0: a sender
    TimeTai due{};  // the event's simulated time, from which settings hold; ns = 0: on arrival
};

// The emulator's side: carries out decoded commands. Called by the receivers' threads, one at a time per
// receiver.
class CommandHandler {
  public:
    virtual ~CommandHandler() = default;
    virtual CommandStatus handle(const Command& command, const CommandSource& source) = 0;
    // Simulated time now.
    virtual TimeTai now() const = 0;
    // Reads the clock for the answer to a ClockCommand that came then.
    virtual ClockReading read_clock(std::int64_t arrival_monotonic_ns) const {
        ClockReading reading;
        reading.arrival = reading.departure = now();
        reading.arrival_monotonic_ns = reading.departure_monotonic_ns = arrival_monotonic_ns;
        return reading;
    }
};

// Counters of one receiver, or of all together.
struct CommandReport {
    std::uint64_t received = 0;
    std::uint64_t refused = 0;
    std::uint64_t lost = 0;           // gaps in the senders' sequence numbers, less what came late
    std::uint64_t duplicates = 0;     // packets whose number had come before
    std::uint64_t went_back = 0;      // poses and angles whose time tag went back
    std::uint64_t skipped_bytes = 0;  // bytes of streams that lay between packets
    std::uint64_t strangers = 0;      // connections and datagrams of senders that are not allowed
    std::uint64_t cut_off = 0;        // clients that did not read their answers
    std::uint64_t clients = 0;        // connected now; over UDP: heard within a minute

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
