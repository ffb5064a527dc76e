#include "io/gige/stream/gvsp.h"

#include "io/system/bytes.h"

namespace hilcam::gvsp {
namespace {

// Extended flags: the packet is a resent one.
constexpr unsigned kResendFlag = 0x0001;

ByteWriter& put_header(ByteWriter& out, const PacketHeader& h) {
    if (!h.extended)
        return out.u16(h.status).u16(h.block & 0xFFFF).u32(std::uint32_t{h.format} << 24 | h.packet);
    out.u16(h.status).u16(h.status == kResent ? kResendFlag : 0u);
    // Bit 7: extended ids. The low byte of the former packet id is the number of parts of a multipart leader.
    return out.u32((0x80u | h.format) << 24 | h.parts).u64(h.block).u32(h.packet);
}

std::uint16_t type_of(PayloadType type, bool chunks) {
    return static_cast<std::uint16_t>(type | (chunks ? kWithChunks : 0));
}

ByteWriter& put_size(ByteWriter& out, const Image& i) {
    // No padding: rows follow each other without a gap.
    return out.u32(i.width).u32(i.height).u32(i.offset_x).u32(i.offset_y).u16(0).u16(0);
}

}  // namespace

std::size_t write_header(const PacketHeader& header, std::span<std::uint8_t> bytes) {
    ByteWriter out(bytes);
    return put_header(out, header).size();
}

std::size_t write_image_leader(const PacketHeader& header, bool chunks, std::uint64_t timestamp_ns,
                               const Image& image, std::span<std::uint8_t> bytes) {
    ByteWriter out(bytes);
    put_header(out, header).u16(0).u16(type_of(kImage, chunks)).u64(timestamp_ns).u32(image.pixel_format);
    return put_size(out, image).size();
}

std::size_t write_multipart_leader(const PacketHeader& header, bool chunks, std::uint64_t timestamp_ns,
                                   std::span<const Part> parts, std::span<std::uint8_t> bytes) {
    ByteWriter out(bytes);
    PacketHeader counted = header;
    counted.parts = static_cast<std::uint8_t>(parts.size());
    put_header(out, counted).u16(0).u16(type_of(kMultipartPayload, chunks)).u64(timestamp_ns);
    for (const Part& part : parts) {
        out.u16(part.type).u16(part.bytes >> 32 & 0xFFFF).u32(part.bytes & 0xFFFFFFFF);
        out.u32(part.image.pixel_format);
        // Reserved, source, additional zones; zone directions; purpose, region.
        out.u16(0).u8(0).u8(0).u32(0).u16(part.purpose).u16(0);
        put_size(out, part.image).u32(0);
    }
    return out.size();
}

std::size_t write_part_payload(const PacketHeader& header, std::uint8_t part, std::uint64_t offset,
                               std::span<std::uint8_t> bytes) {
    ByteWriter out(bytes);
    return put_header(out, header).u8(part).u8(0).u16(offset >> 32 & 0xFFFF).u32(offset & 0xFFFFFFFF).size();
}

std::size_t write_trailer(const PacketHeader& header, PayloadType type, std::uint32_t size_y,
                          const ChunkTail* chunks, std::span<std::uint8_t> bytes) {
    ByteWriter out(bytes);
    put_header(out, header).u16(0).u16(type_of(type, chunks != nullptr)).u32(size_y);
    if (chunks) out.u32(chunks->bytes).u32(chunks->layout);
    return out.size();
}

std::uint32_t packet_id(std::span<const std::uint8_t> packet, bool extended) {
    return extended ? ByteReader(packet.subspan(16, 4)).u32()
                    : ByteReader(packet.subspan(4, 4)).u32() & 0xFFFFFF;
}

void overwrite_packet_id(std::span<std::uint8_t> packet, bool extended, std::uint32_t id) {
    if (extended)
        ByteWriter(packet.subspan(16, 4)).u32(id);
    else
        ByteWriter(packet.subspan(5, 3)).u8(id >> 16 & 0xFF).u16(id & 0xFFFF);
}

}  // namespace hilcam::gvsp
