#pragma once
// Cuts a frame's payload into space packets (CCSDS 133.0-B-2). All packets of a frame are one group: sequence
// flags first, continuation, last, or unsegmented when one packet has it all. The sequence count goes on from
// frame to frame, modulo 2^14.

#include <cstdint>
#include <span>
#include <vector>

#include "io/commands/ccsds.h"
#include "io/packets/image_header.h"

namespace hilcam {

// A strip's payload inside the frame's.
struct StripPayload {
    std::uint16_t first_row = 0, rows = 0;
    std::size_t begin = 0, bytes = 0;
};

class ImageSegmenter {
  public:
    static constexpr std::size_t kMostPacketBytes = 65542;  // 6 + 65,536 (4.1.3.5.3)

    // packet_bytes: the longest packet with its headers and its CRC; at least 128.
    ImageSegmenter(std::uint16_t apid, std::size_t packet_bytes, bool crc);

    // Begins a frame. payload and strips, which are not empty, must stay until its last packet.
    void begin(const ImageFrame& frame, std::span<const std::uint8_t> payload,
               std::span<const StripPayload> strips);
    // Returns the frame's next packet, which is valid until the next call; empty: there is none.
    std::span<const std::uint8_t> next();
    // Leaves out the rest of a frame. Its packets are counted, so that a receiver misses them.
    void skip_rest();

  private:
    std::size_t data_bytes() const;  // largest part of a payload in a packet

    std::uint16_t apid_;
    bool crc_;
    std::vector<std::uint8_t> packet_;
    std::uint16_t count_ = 0;

    ImageFrame frame_;
    std::span<const std::uint8_t> payload_;
    std::span<const StripPayload> strips_;
    std::uint32_t segment_ = 0, segments_ = 0;
    std::size_t strip_ = 0, offset_ = 0;  // the next packet's strip, and offset in it
};

}  // namespace hilcam
