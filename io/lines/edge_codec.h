#pragma once
// An edge of a line as a datagram of 24 bytes, big-endian (docs/lines.md):
//
//     0  magic "HEDG"    4  version 1    5  line 0 to 7    6  level 0, 1    7  clock (EdgeClock)
//     8  camera u16; 0: every camera     10  reserved u16; 0                12  sequence u32
//    16  time i64, ns of that clock; 0 where the clock is kNow

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace hilcam {

enum class EdgeClock : std::uint8_t {
    kNow,        // on arrival
    kMonotonic,  // CLOCK_MONOTONIC of hilcam's machine
    kTai,        // CLOCK_TAI of hilcam's machine
};

struct EdgeDatagram {
    std::uint8_t line = 0;
    bool level = false;
    EdgeClock clock = EdgeClock::kNow;
    std::uint16_t camera = 0;
    std::uint32_t sequence = 0;
    std::int64_t time_ns = 0;

    friend bool operator==(const EdgeDatagram&, const EdgeDatagram&) = default;
};

inline constexpr std::size_t kEdgeBytes = 24;
inline constexpr std::uint32_t kEdgeMagic = 0x48454447;  // "HEDG"
inline constexpr std::uint8_t kEdgeVersion = 1;

// Returns nothing for bytes that are not an edge.
std::optional<EdgeDatagram> decode_edge(std::span<const std::uint8_t> bytes);
std::array<std::uint8_t, kEdgeBytes> encode_edge(const EdgeDatagram& edge);

}  // namespace hilcam
