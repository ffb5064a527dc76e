#include "io/gvcp.h"

#include "io/bytes.h"

namespace hilcam::gvcp {

bool read_header(std::span<const std::uint8_t> datagram, Header& header) {
    if (datagram.size() < kHeaderBytes || datagram[0] != Header::kKey) return false;
    ByteReader in(datagram.subspan(1));
    header.flags = in.u8();
    header.command = in.u16();
    header.length = in.u16();
    header.request_id = in.u16();
    return header.length == datagram.size() - kHeaderBytes && header.request_id != 0;
}

void write_answer_header(Status status, std::uint16_t command, std::size_t payload_bytes,
                         std::uint16_t request_id, std::span<std::uint8_t> out) {
    ByteWriter(out).u16(status).u16(command + 1u).u16(payload_bytes).u16(request_id);
}

bool read_resend(std::span<const std::uint8_t> payload, bool extended, ResendRequest& request) {
    ByteReader in(payload);
    request.channel = in.u16();
    request.block = in.u16();
    request.first_packet = in.u32();
    request.last_packet = in.u32();
    if (extended) {
        request.block = in.u64();
    } else {
        request.first_packet &= 0xFFFFFF;
        request.last_packet &= 0xFFFFFF;
    }
    return in.ok() && request.first_packet <= request.last_packet;
}

}  // namespace hilcam::gvcp
