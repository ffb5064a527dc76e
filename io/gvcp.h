#pragma once
// GigE Vision Control Protocol: the bytes of commands and answers. Pure functions; all numbers big-endian.
// Layouts: GigE Vision 2.x as Wireshark's packet-gvcp dissector and Aravis decode it.

#include <cstdint>
#include <span>

namespace hilcam::gvcp {

inline constexpr std::uint16_t kPort = 3956;
inline constexpr std::size_t kHeaderBytes = 8;
inline constexpr std::size_t kMostDatagramBytes = 576;  // every GVCP message fits
inline constexpr std::size_t kDiscoveryBytes = 248;     // registers 0x00 to 0xF7

enum Command : std::uint16_t {
    kDiscovery = 0x0002,
    kForceIp = 0x0004,
    kPacketResend = 0x0040,
    kReadRegister = 0x0080,
    kWriteRegister = 0x0082,
    kReadMemory = 0x0084,
    kWriteMemory = 0x0086,
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
    kInvalidHeader = 0x800E,
};

struct Header {
    static constexpr std::uint8_t kKey = 0x42;
    static constexpr std::uint8_t kAcknowledgeFlag = 0x01;
    static constexpr std::uint8_t kExtendedFlag =
        0x10;  // 64-bit block ids; on discovery: broadcast answer allowed

    std::uint8_t flags = 0;
    std::uint16_t command = 0;
    std::uint16_t length = 0;  // of the payload
    std::uint16_t request_id = 0;
};

// False for what is no GVCP command: wrong key, too short, or a length that differs from the datagram's.
bool read_header(std::span<const std::uint8_t> datagram, Header& header);
// The 8 bytes before an answer's payload; the answer's code is the command's plus one.
void write_answer_header(Status status, std::uint16_t command, std::size_t payload_bytes,
                         std::uint16_t request_id, std::span<std::uint8_t> out);

// What a PACKETRESEND asks for.
struct ResendRequest {
    std::uint16_t channel = 0;
    std::uint64_t block = 0;
    std::uint32_t first_packet = 0;
    std::uint32_t last_packet = 0;
};
bool read_resend(std::span<const std::uint8_t> payload, bool extended, ResendRequest& request);

}  // namespace hilcam::gvcp
