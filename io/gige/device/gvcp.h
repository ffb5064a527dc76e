#pragma once
// GigE Vision Control Protocol: the bytes of commands and answers, all numbers big-endian. Pure functions.
// Layouts: GigE Vision 2.x as Wireshark's packet-gvcp dissector and Aravis decode it.
//
// A reader returns nothing for a payload of the wrong length or with impossible values; the device answers
// these with INVALID_PARAMETER.

#include <cstdint>
#include <optional>
#include <span>

namespace hilcam::gvcp {

inline constexpr std::uint16_t kPort = 3956;
inline constexpr std::size_t kHeaderBytes = 8;
inline constexpr std::size_t kMaxDatagramBytes = 576;  // every GVCP message fits
inline constexpr std::size_t kDiscoveryBytes = 248;    // registers 0x00 to 0xF7
// The answer to READMEM has the address before the data.
inline constexpr std::size_t kMaxMemoryBytes = kMaxDatagramBytes - 28 - kHeaderBytes - 4;

enum Command : std::uint16_t {
    kDiscovery = 0x0002,
    kForceIp = 0x0004,
    kPacketResend = 0x0040,
    kReadRegister = 0x0080,
    kWriteRegister = 0x0082,
    kReadMemory = 0x0084,
    kWriteMemory = 0x0086,
    kPendingAnswer = 0x0089,  // an answer without a command of its own
    kEvent = 0x00C0,
    kEventData = 0x00C2,
    kAction = 0x0100,
};

enum Status : std::uint16_t {
    kSuccess = 0x0000,
    kNotImplemented = 0x8001,
    kInvalidParameter = 0x8002,
    kInvalidAddress = 0x8003,
    kWriteProtect = 0x8004,
    kBadAlignment = 0x8005,
    kAccessDenied = 0x8006,
    kBusy = 0x8007,
    kPacketUnavailable = 0x800C,
    kDataOverrun = 0x800D,
    kInvalidHeader = 0x800E,
    kPacketNotYetAvailable = 0x8010,
    kPacketAndPreviousRemoved = 0x8011,
    kPacketRemoved = 0x8012,
    kNoReferenceTime = 0x8013,
    kTemporarilyUnavailable = 0x8014,
    kOverflow = 0x8015,
    kActionLate = 0x8016,
    kLeaderTrailerOverflow = 0x8017,
    kGenericError = 0x8FFF,
};

struct Header {
    static constexpr std::uint8_t kKey = 0x42;
    static constexpr std::uint8_t kAcknowledgeFlag = 0x01;
    static constexpr std::uint8_t kExtendedFlag = 0x10;         // PACKETRESEND, EVENT, EVENTDATA: 64-bit ids
    static constexpr std::uint8_t kBroadcastAnswerFlag = 0x10;  // DISCOVERY, FORCEIP
    static constexpr std::uint8_t kScheduledFlag = 0x80;        // ACTION

    std::uint8_t flags = 0;
    std::uint16_t command = 0;
    std::uint16_t length = 0;  // length of the payload
    std::uint16_t request_id = 0;
};
// Returns nothing when it is not a GVCP command: wrong key, too short, id 0.
std::optional<Header> read_header(std::span<const std::uint8_t> datagram);
void write_header(const Header& header, std::span<std::uint8_t> out);

// The 8 bytes before an answer. The code is the command's plus one, except for PENDING_ACK, which has no
// command.
struct AnswerHeader {
    std::uint16_t status = kSuccess;
    std::uint16_t code = 0;
    std::uint16_t length = 0;
    std::uint16_t request_id = 0;
};
std::optional<AnswerHeader> read_answer_header(std::span<const std::uint8_t> datagram);
void write_answer_header(const AnswerHeader& header, std::span<std::uint8_t> out);
// Returns the datagram's size.
std::size_t write_pending_answer(std::uint16_t request_id, std::uint16_t ms, std::span<std::uint8_t> out);

struct ForceIp {
    std::uint64_t mac = 0;
    std::uint32_t ip = 0, mask = 0, gateway = 0;  // ip 0: configure anew
};
std::optional<ForceIp> read_force_ip(std::span<const std::uint8_t> payload);

// The packets that a PACKETRESEND asks for.
struct ResendRequest {
    std::uint16_t channel = 0;
    std::uint64_t block = 0;
    std::uint32_t first_packet = 0;
    std::uint32_t last_packet = 0;
    bool extended = false;  // requested with 64-bit ids
};
std::optional<ResendRequest> read_resend(std::span<const std::uint8_t> payload, bool extended);

struct MemoryRange {
    std::uint32_t address = 0;
    std::uint16_t bytes = 0;
};
std::optional<MemoryRange> read_memory_range(std::span<const std::uint8_t> payload);

struct Action {
    std::uint32_t device_key = 0, group_key = 0, group_mask = 0;
    std::optional<std::uint64_t> at{};  // time on the device's clock
};
std::optional<Action> read_action(std::span<const std::uint8_t> payload, bool scheduled);

// An item of an EVENT or, with data, of an EVENTDATA.
struct Event {
    enum Id : std::uint16_t { kPrimarySwitch = 0x0007, kLinkSpeed = 0x0008, kActionLate = 0x0009 };
    static constexpr std::uint16_t kFirstOfDevice = 0x9000;
    static constexpr std::uint16_t kNoChannel = 0xFFFF;

    std::uint16_t id = 0;
    std::uint16_t channel = kNoChannel;
    std::uint64_t block = 0;
    std::uint64_t timestamp = 0;
};
constexpr std::size_t event_item_bytes(bool extended) { return extended ? 24 : 16; }
// Writes a whole datagram, with data an EVENTDATA; returns its size.
std::size_t write_event(const Event& event, bool extended, bool acknowledge, std::uint16_t request_id,
                        std::span<const std::uint8_t> data, std::span<std::uint8_t> out);

}  // namespace hilcam::gvcp
