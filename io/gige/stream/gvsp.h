#pragma once
// GigE Vision Streaming Protocol: the bytes of leaders, payload headers and trailers, all numbers big-endian.
// Pure functions. Layouts: GigE Vision 2.x as Wireshark's packet-gvsp dissector and Aravis decode it.
//
// A block (a frame) is a leader with packet id 0, payload packets 1 to n, and a trailer n + 1. Short headers
// have 16-bit block ids (1 to 65535) and 24-bit packet ids, extended ones 64 and 32 bits. A packet-size
// register includes the IP, UDP and GVSP headers.

#include <cstdint>
#include <span>

namespace hilcam::gvsp {

enum Status : std::uint16_t {
    kFresh = 0x0000,
    kResent = 0x0100,
    kUnavailable = 0x800C,           // the packet never existed, or is withheld
    kNotYetAvailable = 0x8010,       // a block that is still to come
    kRemovedWithAllBefore = 0x8011,  // no longer kept, nor is any block before it
    kRemoved = 0x8012,               // no longer kept
};

enum Format : std::uint8_t { kLeader = 1, kTrailer = 2, kPayload = 3, kMultipart = 7 };

enum PayloadType : std::uint16_t { kImage = 0x0001, kMultipartPayload = 0x000A, kWithChunks = 0x4000 };

constexpr std::size_t header_bytes(bool extended) { return extended ? 20 : 8; }
// Returns the bytes that a packet-size register includes besides the payload: IP 20, UDP 8, GVSP.
constexpr std::size_t overhead_bytes(bool extended) { return 28 + header_bytes(extended); }
inline constexpr std::size_t kPartPrefixBytes = 8;  // before a multipart payload

struct PacketHeader {
    Status status = kFresh;
    Format format = kPayload;
    bool extended = false;
    std::uint64_t block = 0;
    std::uint32_t packet = 0;
    std::uint8_t parts = 0;  // number of parts, in a multipart leader
};

struct Image {
    std::uint32_t pixel_format = 0;  // PFNC
    std::uint32_t width = 0, height = 0, offset_x = 0, offset_y = 0;
};

// One part of a multipart block.
struct Part {
    enum Type : std::uint16_t {
        k2dImage = 0x0001,
        kConfidenceMap = 0x0009,
        kChunkData = 0x000A
    } type = k2dImage;
    std::uint64_t bytes = 0;
    Image image;                // all 0 for chunk data
    std::uint16_t purpose = 0;  // ComponentIDValue of the component
};

inline constexpr std::size_t kMaxParts = 3;
// The longest header with its contents: a multipart leader.
inline constexpr std::size_t kMaxHeadBytes = header_bytes(true) + 12 + 48 * kMaxParts;

// All write to the front of `out` (kMaxHeadBytes suffice) and return the number of bytes, header included.
std::size_t write_header(const PacketHeader& header, std::span<std::uint8_t> out);
std::size_t write_image_leader(const PacketHeader& header, bool chunks, std::uint64_t timestamp_ns,
                               const Image& image, std::span<std::uint8_t> out);
std::size_t write_multipart_leader(const PacketHeader& header, bool chunks, std::uint64_t timestamp_ns,
                                   std::span<const Part> parts, std::span<std::uint8_t> out);
// Writes the header and the place of a multipart payload: its part and its offset in the whole block.
std::size_t write_part_payload(const PacketHeader& header, std::uint8_t part, std::uint64_t offset,
                               std::span<std::uint8_t> out);

struct ChunkTail {
    std::uint32_t bytes = 0;   // all chunks, with their ids and lengths
    std::uint32_t layout = 0;  // changes when the set of chunks does
};
// type: the leader's. chunks: null without. A multipart trailer has a height as well, which its readers do
// not need.
std::size_t write_trailer(const PacketHeader& header, PayloadType type, std::uint32_t size_y,
                          const ChunkTail* chunks, std::span<std::uint8_t> out);

// Read and overwrite the id in a finished packet, for faults that need a wrong one.
std::uint32_t packet_id(std::span<const std::uint8_t> packet, bool extended);
void overwrite_packet_id(std::span<std::uint8_t> packet, bool extended, std::uint32_t id);

}  // namespace hilcam::gvsp
