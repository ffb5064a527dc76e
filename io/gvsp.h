#pragma once
// GigE Vision Streaming Protocol: headers of leader, payload and trailer packets, short (16-bit) block ids.
// Packet ids: leader 0, payload 1 .. n, trailer n + 1.

#include <cstdint>
#include <span>

namespace hilcam::gvsp {

inline constexpr std::size_t kHeaderBytes = 8;
inline constexpr std::size_t kLeaderBytes = kHeaderBytes + 36;
inline constexpr std::size_t kTrailerBytes = kHeaderBytes + 8;
// What a packet-size register counts beyond the payload: IP 20, UDP 8, GVSP 8.
inline constexpr std::size_t kOverheadBytes = 36;

enum PixelFormat : std::uint32_t { kMono8 = 0x01080001, kMono12 = 0x01100005, kMono16 = 0x01100007 };
inline constexpr std::uint32_t bytes_per_pixel(std::uint32_t format) { return (format >> 16 & 0xFF) / 8; }

struct ImageInfo {
    std::uint64_t timestamp_ns = 0;
    std::uint32_t pixel_format = kMono8;
    std::uint32_t width = 0, height = 0, offset_x = 0, offset_y = 0;
};

void write_leader(std::uint16_t block, const ImageInfo& image, std::span<std::uint8_t> out);
void write_payload_header(std::uint16_t block, std::uint32_t packet, std::span<std::uint8_t> out);
void write_trailer(std::uint16_t block, std::uint32_t packet, std::uint32_t height,
                   std::span<std::uint8_t> out);
// "This packet cannot be had": the answer to a resend request for what is gone.
void write_unavailable(std::uint16_t block, std::uint32_t packet, std::uint16_t status,
                       std::span<std::uint8_t> out);

}  // namespace hilcam::gvsp
