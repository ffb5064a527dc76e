#include "io/gige_packets.h"

#include <algorithm>

#include "io/bytes.h"

namespace hilcam {
namespace {

bool is_multipart(const GigeStreamState& s) { return s.multipart && s.extended_ids; }

// Payload bytes of a full packet.
std::size_t piece_bytes(const GigeStreamState& s) {
    return s.packet_bytes - gvsp::overhead_bytes(s.extended_ids) -
           (is_multipart(s) ? gvsp::kPartPrefixBytes : 0);
}
std::uint32_t pieces(std::size_t bytes, const GigeStreamState& s) {
    return static_cast<std::uint32_t>((bytes + piece_bytes(s) - 1) / piece_bytes(s));
}

gvsp::Image image_of(const GigeFrame& f) {
    const GigeStreamState& s = f.stream;
    const BayerPattern seen = shifted(f.pattern, static_cast<int>(s.offset_x), static_cast<int>(s.offset_y));
    return {pfnc_code(s.format, seen), s.width, s.height, s.offset_x, s.offset_y};
}

// A layout id names the set of chunks; 0 is reserved for "not told".
gvsp::ChunkTail chunk_tail(const GigeStreamState& s) {
    return {static_cast<std::uint32_t>(s.payload_bytes()), s.chunks + 1};
}

GigePacket leader_of(const GigeFrame& f, const gvsp::PacketHeader& header) {
    const GigeStreamState& s = f.stream;
    GigePacket p;
    if (!is_multipart(s)) {
        p.head_bytes = gvsp::write_image_leader(header, s.chunk_mode, f.timestamp_ns, image_of(f), p.head);
        return p;
    }
    const std::array<gvsp::Part, gvsp::kMostParts> parts = {
        {{gvsp::Part::k2dImage, s.image_bytes(), image_of(f)},
         {gvsp::Part::kChunkData, s.payload_bytes() - s.image_bytes(), {}}}};
    p.head_bytes = gvsp::write_multipart_leader(header, s.chunk_mode, f.timestamp_ns,
                                                std::span(parts).first(s.chunk_mode ? 2 : 1), p.head);
    return p;
}

GigePacket trailer_of(const GigeFrame& f, const gvsp::PacketHeader& header) {
    const GigeStreamState& s = f.stream;
    const gvsp::ChunkTail tail = chunk_tail(s);
    const gvsp::ChunkTail* const chunks = s.chunk_mode ? &tail : nullptr;
    const auto size_y = s.height + static_cast<std::uint32_t>(f.size_y_error);
    GigePacket p;
    p.head_bytes = gvsp::write_trailer(header, is_multipart(s) ? gvsp::kMultipartPayload : gvsp::kImage,
                                       size_y, chunks, p.head);
    return p;
}

// --- chunks
// ----------------------------------------------------------------------------------------------------------------------

void write_chunk(ByteWriter& out, Chunk chunk, const FrameRecord& r, const GigeStreamState& s,
                 BayerPattern seen, std::uint64_t timestamp_ns) {
    switch (chunk) {
        case Chunk::kFrameId:
            out.u64(r.id);
            break;
        case Chunk::kTimestamp:
            out.u64(timestamp_ns);
            break;
        case Chunk::kExposureTime:
            out.f64(r.exposure_s * 1e6);
            break;
        case Chunk::kGain:
            out.f64(r.gain_db);
            break;
        case Chunk::kBlackLevel:
            out.f64(r.black_level_dn);
            break;
        case Chunk::kOffsetX:
            out.u32(s.offset_x);
            break;
        case Chunk::kOffsetY:
            out.u32(s.offset_y);
            break;
        case Chunk::kWidth:
            out.u32(s.width);
            break;
        case Chunk::kHeight:
            out.u32(s.height);
            break;
        case Chunk::kPixelFormat:
            out.u32(pfnc_code(s.format, seen));
            break;
        case Chunk::kPoseSequence:
            out.u32(r.pose_sequence);
            break;
        case Chunk::kPoseTime:
            out.u64(static_cast<std::uint64_t>(r.pose_time.ns));
            break;
        case Chunk::kExposureMid:
            out.u64(static_cast<std::uint64_t>(r.exposure_mid.ns));
            break;
        case Chunk::kTriggerSequence:
            out.u32(r.trigger_sequence);
            break;
        case Chunk::kFaults:
            out.u64(r.faults);
            break;
    }
}

}  // namespace

std::size_t most_payload_bytes(int width, int height, BayerPattern pattern) {
    GigeStreamState all;
    all.width = static_cast<std::uint32_t>(width);
    all.height = static_cast<std::uint32_t>(height);
    all.chunk_mode = true;
    all.chunks = (1u << kChunks) - 1;
    std::size_t most = 0;
    for (const WireFormat format : formats_of(pattern)) {
        all.format = format;
        most = std::max(most, all.payload_bytes());
    }
    return most;
}

void write_gige_payload(const DnImage& frame, const FrameRecord& record, const GigeStreamState& s,
                        BayerPattern pattern, std::uint64_t timestamp_ns, std::span<std::uint16_t> scratch,
                        std::span<std::uint8_t> out) {
    const Crop crop{static_cast<int>(s.offset_x), static_cast<int>(s.offset_y), static_cast<int>(s.width),
                    static_cast<int>(s.height)};
    const BayerPattern seen = shifted(pattern, crop.left, crop.top);
    write_wire(frame, crop, record.bits, s.format, seen, scratch, out.first(s.image_bytes()));
    if (!s.chunk_mode) return;
    ByteWriter chunks(out.subspan(s.image_bytes(), s.payload_bytes() - s.image_bytes()));
    chunks.u32(kImageChunkId).u32(s.image_bytes());
    for (int i = 0; i < kChunks; ++i) {
        if ((s.chunks >> i & 1u) == 0) continue;
        const auto chunk = static_cast<Chunk>(i);
        write_chunk(chunks, chunk, record, s, seen, timestamp_ns);
        chunks.u32(kChunkIdBase + static_cast<std::uint32_t>(i)).u32(chunk_bytes(chunk));
    }
}

std::uint32_t trailer_id(const GigeStreamState& s) {
    if (!is_multipart(s)) return pieces(s.payload_bytes(), s) + 1;
    // Packets hold bytes of one part each.
    return pieces(s.image_bytes(), s) + pieces(s.payload_bytes() - s.image_bytes(), s) + 1;
}

GigePacket packet_of(const GigeFrame& f, std::uint32_t id, gvsp::Status status) {
    const GigeStreamState& s = f.stream;
    const std::uint32_t last = trailer_id(s);
    gvsp::PacketHeader header{.status = status, .extended = s.extended_ids, .block = f.block, .packet = id};
    header.format = id == 0 ? gvsp::kLeader : id >= last ? gvsp::kTrailer : gvsp::kPayload;
    if (header.format == gvsp::kLeader) return leader_of(f, header);
    if (header.format == gvsp::kTrailer) return trailer_of(f, header);
    GigePacket p;
    std::size_t from = (id - 1) * piece_bytes(s), end = s.payload_bytes();
    if (is_multipart(s)) {
        const std::uint32_t of_image = pieces(s.image_bytes(), s);
        const bool image = id <= of_image;
        if (!image) from = s.image_bytes() + (id - 1 - of_image) * piece_bytes(s);
        if (image) end = s.image_bytes();
        header.format = gvsp::kMultipart;
        p.head_bytes = gvsp::write_part_payload(header, image ? 0 : 1, from, p.head);
    } else {
        p.head_bytes = gvsp::write_header(header, p.head);
    }
    p.data = f.payload.subspan(from, std::min(piece_bytes(s), end - from));
    return p;
}

GigePacket refusal_of(bool extended, std::uint64_t block, std::uint32_t id, gvsp::Status reason) {
    GigePacket p;
    p.head_bytes = gvsp::write_header(
        {.status = reason, .format = gvsp::kPayload, .extended = extended, .block = block, .packet = id},
        p.head);
    return p;
}

}  // namespace hilcam
