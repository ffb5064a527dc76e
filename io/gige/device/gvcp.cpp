#include "io/gige/device/gvcp.h"

#include "io/system/bytes.h"

namespace hilcam::gvcp {

std::optional<Header> read_header(std::span<const std::uint8_t> datagram) {
    ByteReader in(datagram);
    if (in.u8() != Header::kKey) return {};
    Header header;
    header.flags = in.u8();
    header.command = in.u16();
    header.length = in.u16();
    header.request_id = in.u16();
    if (!in.ok() || header.request_id == 0) return {};
    return header;
}

void write_header(const Header& h, std::span<std::uint8_t> out) {
    ByteWriter(out).u8(Header::kKey).u8(h.flags).u16(h.command).u16(h.length).u16(h.request_id);
}

std::optional<AnswerHeader> read_answer_header(std::span<const std::uint8_t> datagram) {
    ByteReader in(datagram);
    AnswerHeader header;
    header.status = in.u16();
    header.code = in.u16();
    header.length = in.u16();
    header.request_id = in.u16();
    if (!in.ok() || header.length != in.left() || header.request_id == 0) return {};
    return header;
}

void write_answer_header(const AnswerHeader& h, std::span<std::uint8_t> out) {
    ByteWriter(out).u16(h.status).u16(h.code).u16(h.length).u16(h.request_id);
}

std::size_t write_pending_answer(std::uint16_t request_id, std::uint16_t ms, std::span<std::uint8_t> out) {
    write_answer_header({kSuccess, kPendingAnswer, 4, request_id}, out);
    ByteWriter(out.subspan(kHeaderBytes)).u16(0).u16(ms);
    return kHeaderBytes + 4;
}

std::optional<ForceIp> read_force_ip(std::span<const std::uint8_t> payload) {
    if (payload.size() != 56) return {};
    ByteReader in(payload);
    ForceIp f;
    in.skip(2);
    f.mac = in.u16();
    f.mac = f.mac << 32 | in.u32();
    in.skip(12);
    f.ip = in.u32();
    in.skip(12);
    f.mask = in.u32();
    in.skip(12);
    f.gateway = in.u32();
    return f;
}

std::optional<ResendRequest> read_resend(std::span<const std::uint8_t> payload, bool extended) {
    if (payload.size() != (extended ? 20 : 12)) return {};
    ByteReader in(payload);
    ResendRequest request;
    request.extended = extended;
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
    if (request.block == 0 || request.first_packet > request.last_packet) return {};
    return request;
}

std::optional<MemoryRange> read_memory_range(std::span<const std::uint8_t> payload) {
    if (payload.size() != 8) return {};
    ByteReader in(payload);
    MemoryRange range;
    range.address = in.u32();
    in.skip(2);
    range.bytes = in.u16();
    if (range.bytes == 0 || range.bytes > kMaxMemoryBytes) return {};
    return range;
}

std::optional<Action> read_action(std::span<const std::uint8_t> payload, bool scheduled) {
    if (payload.size() != (scheduled ? 20 : 12)) return {};
    ByteReader in(payload);
    Action action;
    action.device_key = in.u32();
    action.group_key = in.u32();
    action.group_mask = in.u32();
    if (scheduled) action.at = in.u64();
    return action;
}

std::size_t write_event(const Event& event, bool extended, bool acknowledge, std::uint16_t request_id,
                        std::span<const std::uint8_t> data, std::span<std::uint8_t> out) {
    const std::size_t bytes = event_item_bytes(extended) + data.size();
    Header header;
    header.flags = static_cast<std::uint8_t>((acknowledge ? Header::kAcknowledgeFlag : 0) |
                                             (extended ? Header::kExtendedFlag : 0));
    header.command = data.empty() ? kEvent : kEventData;
    header.length = static_cast<std::uint16_t>(bytes);
    header.request_id = request_id;
    write_header(header, out);
    ByteWriter item(out.subspan(kHeaderBytes));
    // Items with short ids have no size field of their own.
    item.u16(extended ? bytes : 0).u16(event.id).u16(event.channel);
    if (extended)
        item.u16(0).u64(event.block);
    else
        item.u16(event.block & 0xFFFF);
    item.u64(event.timestamp).copy(data);
    return kHeaderBytes + item.size();
}

}  // namespace hilcam::gvcp
