#include "io/gvsp.h"

#include "io/bytes.h"

namespace hilcam::gvsp {
namespace {

constexpr unsigned kLeader = 1, kTrailer = 2, kPayload = 3, kImage = 1;

ByteWriter& header(ByteWriter& out, unsigned status, std::uint16_t block, unsigned kind,
                   std::uint32_t packet) {
    return out.u16(status).u16(block).u32(kind << 24 | packet);
}

}  // namespace

void write_leader(std::uint16_t block, const ImageInfo& i, std::span<std::uint8_t> bytes) {
    ByteWriter out(bytes);
    header(out, 0, block, kLeader, 0).u16(0).u16(kImage).u64(i.timestamp_ns).u32(i.pixel_format);
    out.u32(i.width).u32(i.height).u32(i.offset_x).u32(i.offset_y).u16(0).u16(0);
}

void write_payload_header(std::uint16_t block, std::uint32_t packet, std::span<std::uint8_t> bytes) {
    ByteWriter out(bytes);
    header(out, 0, block, kPayload, packet);
}

void write_trailer(std::uint16_t block, std::uint32_t packet, std::uint32_t height,
                   std::span<std::uint8_t> bytes) {
    ByteWriter out(bytes);
    header(out, 0, block, kTrailer, packet).u16(0).u16(kImage).u32(height);
}

void write_unavailable(std::uint16_t block, std::uint32_t packet, std::uint16_t status,
                       std::span<std::uint8_t> bytes) {
    ByteWriter out(bytes);
    header(out, status, block, kPayload, packet);
}

}  // namespace hilcam::gvsp
