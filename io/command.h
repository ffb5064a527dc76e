#pragma once
// Commands, decoded: what a sender can ask of the camera. Bytes are ccsds.h's business, transport
// commands_udp.h's.

#include <cstdint>
#include <optional>
#include <variant>

#include "io/fault.h"
#include "render/pose.h"

namespace hilcam {

// Object 0 is the camera, 1, 2, ... the scenario's objects in their order.
struct PoseCommand {
    std::uint16_t object = 0;
    // motion.time: the instant the pose is true at, simulated TAI; ns = 0 means "on arrival".
    Motion motion;
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
// In the order of their function codes.
using Command = std::variant<PoseCommand, SettingsCommand, StartCommand, StopCommand, PingCommand,
                             JointCommand, FaultCommand, ExposeCommand, TriggerModeCommand, SubscribeCommand>;

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
    kTimeOutOfRange = 8,  // a time tag more than an hour from the simulated now
    kBusy = 9,            // the trigger came too early, or too many frames are waiting: try again later
    kNotNow = 10,         // the camera's mode has no use for it
};

// What the emulator does with a decoded command. Called by the receivers' threads, one at a time per
// receiver.
class CommandHandler {
  public:
    virtual ~CommandHandler() = default;
    virtual CommandStatus handle(const Command& command, std::uint32_t sequence,
                                 std::int64_t arrival_monotonic_ns) = 0;
    // Simulated time now.
    virtual TimeTai now() const = 0;
};

// Counters of one receiver. `lost` counts gaps in the senders' sequence numbers.
struct CommandReport {
    std::uint64_t received = 0;
    std::uint64_t refused = 0;
    std::uint64_t lost = 0;
};

}  // namespace hilcam
