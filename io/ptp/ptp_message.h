#pragma once
// The bytes of PTP messages: IEEE 1588-2008, clause 13. Header, Announce, Sync, Follow_Up, Delay_Req and
// Delay_Resp; other types are read as their header alone. No socket, no state.

#include <compare>
#include <cstdint>
#include <optional>
#include <span>

namespace hilcam::ptp {

enum class MessageType : std::uint8_t {  // table 19
    kSync = 0x0,
    kDelayReq = 0x1,
    kFollowUp = 0x8,
    kDelayResp = 0x9,
    kAnnounce = 0xB,
};

struct PortIdentity {
    std::uint64_t clock = 0;  // EUI-64
    std::uint16_t port = 0;
    friend auto operator<=>(const PortIdentity&, const PortIdentity&) = default;
};

// Bits of the flag field, first octet in the upper half (table 20).
namespace flag {
inline constexpr std::uint16_t kAlternateMaster = 0x0100, kTwoStep = 0x0200, kUtcOffsetValid = 0x0004,
                               kPtpTimescale = 0x0008;
}

// Returns the EUI-64 that IEEE 1588-2008, 7.5.2.2.2 makes from a MAC address (48 bits).
constexpr std::uint64_t identity_of_mac(std::uint64_t mac) {
    return mac >> 24 << 40 | std::uint64_t{0xFFFE} << 24 | (mac & 0xFFFFFF);
}

struct Announce {
    std::int16_t utc_offset_s = 0;  // TAI minus UTC
    std::uint8_t priority1 = 128;
    std::uint8_t clock_class = 248;
    std::uint8_t accuracy = 0xFE;
    std::uint16_t variance = 0xFFFF;
    std::uint8_t priority2 = 128;
    std::uint64_t grandmaster = 0;
    std::uint16_t steps_removed = 0;
    std::uint8_t time_source = 0xA0;
};

struct Message {
    MessageType type{};
    std::uint8_t domain = 0;
    std::uint16_t flags = 0;
    std::int64_t correction_scaled_ns = 0;  // 2^-16 ns
    PortIdentity source;
    std::uint16_t sequence = 0;
    std::int8_t log_interval = 0;  // base 2, of seconds
    // The time stamp in the body: origin, precise origin or receive time stamp. Sync, Follow_Up, Delay_Resp.
    std::int64_t time_ns = 0;
    PortIdentity requester{};  // Delay_Resp
    Announce announce{};       // Announce

    bool has(std::uint16_t bit) const { return (flags & bit) != 0; }
};

// Times beyond this are refused: it is the year 2096, and sums of such times fit into int64.
inline constexpr std::int64_t kMaxTime_s = 4'000'000'000;
// So are corrections of more than an hour.
inline constexpr std::int64_t kMaxCorrection_ns = 3'600'000'000'000;
inline constexpr std::size_t kDelayReqBytes = 44, kMaxMessageBytes = 64;

// Returns nothing when the bytes are no message of one of these types, of version 2 and of transportSpecific
// 0; when they are shorter than their length field or their type's length; or when a time or a correction is
// out of range. Bytes after the message (TLVs, padding) are ignored.
std::optional<Message> read_message(std::span<const std::uint8_t> bytes);
// Returns how many bytes were written; `out` has at least kMaxMessageBytes.
std::size_t write_message(const Message& message, std::span<std::uint8_t> out);

}  // namespace hilcam::ptp
