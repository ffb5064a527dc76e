#include "io/lines/edge_codec.h"

#include "io/lines/line_edge.h"
#include "io/system/bytes.h"

namespace hilcam {

std::optional<EdgeDatagram> decode_edge(std::span<const std::uint8_t> bytes) {
    if (bytes.size() != kEdgeBytes) return {};
    ByteReader in(bytes);
    if (in.u32() != kEdgeMagic || in.u8() != kEdgeVersion) return {};
    EdgeDatagram edge;
    edge.line = in.u8();
    const std::uint8_t level = in.u8(), clock = in.u8();
    edge.camera = in.u16();
    const std::uint16_t reserved = in.u16();
    edge.sequence = in.u32();
    edge.time_ns = in.i64();
    if (edge.line >= kLines || level > 1 || clock > static_cast<std::uint8_t>(EdgeClock::kTai) ||
        reserved != 0)
        return {};
    edge.level = level != 0;
    edge.clock = static_cast<EdgeClock>(clock);
    // A time that no clock counts is a sender's mistake.
    if ((edge.clock == EdgeClock::kNow) != (edge.time_ns == 0)) return {};
    return edge;
}

std::array<std::uint8_t, kEdgeBytes> encode_edge(const EdgeDatagram& edge) {
    std::array<std::uint8_t, kEdgeBytes> bytes{};
    ByteWriter(bytes)
        .u32(kEdgeMagic)
        .u8(kEdgeVersion)
        .u8(edge.line)
        .u8(edge.level ? 1 : 0)
        .u8(static_cast<std::uint8_t>(edge.clock))
        .u16(edge.camera)
        .u16(0)
        .u32(edge.sequence)
        .u64(static_cast<std::uint64_t>(edge.time_ns));
    return bytes;
}

}  // namespace hilcam
