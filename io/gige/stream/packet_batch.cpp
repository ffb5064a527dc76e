#include "io/gige/stream/packet_batch.h"

#include <algorithm>
#include <cerrno>

namespace hilcam {

void PacketBatch::add(const GigePacket& packet, const PacketFate& fate, bool extended) {
    Message& m = messages_[count_];
    m.packet = packet;
    if (fate.id_error != 0) {
        const auto id = static_cast<std::uint32_t>(gvsp::packet_id(m.packet.head, extended) + fate.id_error);
        gvsp::overwrite_packet_id(m.packet.head, extended, id);
    }
    // At least one byte is left of every packet.
    std::size_t parts = 0, left = packet.bytes() - std::min(packet.bytes() - 1, fate.cut_bytes);
    bytes_ += left + 28;
    const auto put = [&](const std::uint8_t* data, std::size_t size) {
        const std::size_t taken = std::min(size, left);
        // sendmmsg() only reads.
        if (taken > 0) m.parts[parts++] = {const_cast<std::uint8_t*>(data), taken};
        left -= taken;
    };
    put(m.packet.head.data(), m.packet.head_bytes);
    const std::uint8_t* const data = packet.data.data();
    const std::size_t size = packet.data.size(), wrong = size / 2;
    if (fate.corrupt && size > 0) {
        m.inverted = static_cast<std::uint8_t>(~data[wrong]);
        put(data, wrong);
        put(&m.inverted, 1);
        put(data + wrong + 1, size - wrong - 1);
    } else {
        put(data, size);
    }
    mmsghdr& header = headers_[count_++];
    header = {};
    header.msg_hdr.msg_name = &to_;
    header.msg_hdr.msg_namelen = sizeof to_;
    header.msg_hdr.msg_iov = m.parts.data();
    header.msg_hdr.msg_iovlen = parts;
}

std::size_t PacketBatch::send(int socket) noexcept {
    std::size_t lost = 0;
    for (std::size_t at = 0; at < count_;) {
        const int taken = sendmmsg(socket, headers_.data() + at, static_cast<unsigned>(count_ - at), 0);
        if (taken < 0 && errno == EINTR) continue;
        // An error belongs to the first remaining packet.
        at += taken > 0 ? static_cast<std::size_t>(taken) : 1;
        if (taken <= 0) ++lost;
    }
    return lost;
}

}  // namespace hilcam
