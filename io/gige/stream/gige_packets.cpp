#include "io/gige/stream/gige_packets.h"

#include <algorithm>

#include "io/gige/stream/gige_chunk_layout.h"
#include "io/system/bytes.h"

namespace hilcam {
namespace {

// PFNC 2.4.
constexpr std::uint32_t kConfidence8 = 0x010800C6;

// Returns the payload bytes of a full packet.
std::size_t piece_bytes(const GigeStreamState& s) {
    return s.packet_bytes - gvsp::overhead_bytes(s.long_ids()) - (s.multipart ? gvsp::kPartPrefixBytes : 0);
}
std::uint32_t pieces(std::size_t bytes, const GigeStreamState& s) {
    return static_cast<std::uint32_t>((bytes + piece_bytes(s) - 1) / piece_bytes(s));
}

gvsp::Image image_of(const GigeFrame& f) {
    const GigeStreamState& s = f.stream;
    const BayerPattern seen = shifted(f.pattern, static_cast<int>(s.offset_x), static_cast<int>(s.offset_y));
    return {pfnc_code(s.format, seen), s.width, s.height, s.offset_x, s.offset_y};
}

// Returns the sizes of the parts, in the order of the payload; 0: absent. A plain stream has a single part.
std::array<std::size_t, gvsp::kMaxParts> part_bytes(const GigeStreamState& s) {
    if (!s.multipart) return {s.payload_bytes()};
    return {s.image_bytes(), s.confidence_bytes(), s.chunk_data_bytes()};
}

std::size_t write_parts_leader(const GigeFrame& f, const gvsp::PacketHeader& header,
                               std::span<std::uint8_t> out) {
    const GigeStreamState& s = f.stream;
    gvsp::Image confidence = image_of(f);
    confidence.pixel_format = kConfidence8;
    const auto [image_bytes, confidence_bytes, chunk_bytes] = part_bytes(s);
    const std::array<gvsp::Part, gvsp::kMaxParts> all = {
        {{gvsp::Part::k2dImage, image_bytes, image_of(f), id_of(GigeComponent::kIntensity)},
         {gvsp::Part::kConfidenceMap, confidence_bytes, confidence, id_of(GigeComponent::kConfidence)},
         {gvsp::Part::kChunkData, chunk_bytes, {}}}};
    std::array<gvsp::Part, gvsp::kMaxParts> parts;
    const auto end =
        std::copy_if(all.begin(), all.end(), parts.begin(), [](const gvsp::Part& p) { return p.bytes > 0; });
    return gvsp::write_multipart_leader(header, s.chunk_mode, f.timestamp_ns, {parts.begin(), end}, out);
}

// A layout id names the set of chunks; 0 is reserved for "unknown".
gvsp::ChunkTail chunk_tail(const GigeStreamState& s) {
    return {static_cast<std::uint32_t>(s.payload_bytes()), s.chunks + 1};
}

GigePacket leader_of(const GigeFrame& f, const gvsp::PacketHeader& header) {
    const GigeStreamState& s = f.stream;
    GigePacket p;
    p.head_bytes = s.multipart
                       ? write_parts_leader(f, header, p.head)
                       : gvsp::write_image_leader(header, s.chunk_mode, f.timestamp_ns, image_of(f), p.head);
    return p;
}

GigePacket trailer_of(const GigeFrame& f, const gvsp::PacketHeader& header) {
    const GigeStreamState& s = f.stream;
    const gvsp::ChunkTail tail = chunk_tail(s);
    const gvsp::ChunkTail* const chunks = s.chunk_mode ? &tail : nullptr;
    const auto size_y = s.height + static_cast<std::uint32_t>(f.size_y_error);
    GigePacket p;
    p.head_bytes = gvsp::write_trailer(header, s.multipart ? gvsp::kMultipartPayload : gvsp::kImage, size_y,
                                       chunks, p.head);
    return p;
}

// --- chunks

void write_confidence(const DnImage& frame, const Crop& crop, int bits, std::span<std::uint8_t> out) {
    const auto full_scale = static_cast<std::uint16_t>((1u << bits) - 1);
    auto at = out.begin();
    for (int y = crop.top; y < crop.top + crop.height; ++y) {
        const auto row =
            frame.row(y).subspan(static_cast<std::size_t>(crop.left), static_cast<std::size_t>(crop.width));
        at = std::transform(row.begin(), row.end(), at, [full_scale](std::uint16_t dn) {
            return static_cast<std::uint8_t>(dn == 0 || dn >= full_scale ? 0 : 255);
        });
    }
}

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
        case Chunk::kSequencerSet:
            out.u32(static_cast<std::uint32_t>(std::max<std::int64_t>(0, r.sequencer_set)));
            break;
    }
}

}  // namespace

std::size_t max_payload_bytes(int width, int height, BayerPattern pattern, bool multipart) {
    GigeStreamState all;
    all.width = static_cast<std::uint32_t>(width);
    all.height = static_cast<std::uint32_t>(height);
    all.multipart = multipart;
    if (multipart) all.components |= bit_of(GigeComponent::kConfidence);
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
    if (s.image_bytes() > 0)
        write_wire(frame, crop, record.bits, s.format, seen, scratch, out.first(s.image_bytes()));
    if (s.confidence_bytes() > 0)
        write_confidence(frame, crop, record.bits, out.subspan(s.image_bytes(), s.confidence_bytes()));
    if (!s.chunk_mode) return;
    const auto behind = out.subspan(s.image_bytes() + s.confidence_bytes(), s.chunk_data_bytes());
    if (s.chunk_layout)
        return write_chunk_layout(*s.chunk_layout, record, s, seen, timestamp_ns,
                                  s.image_bytes() + s.confidence_bytes(), behind);
    ByteWriter chunks(behind);
    chunks.u32(kImageChunkId).u32(s.image_bytes() + s.confidence_bytes());
    for (int i = 0; i < kChunks; ++i) {
        if ((s.chunks >> i & 1u) == 0) continue;
        const auto chunk = static_cast<Chunk>(i);
        write_chunk(chunks, chunk, record, s, seen, timestamp_ns);
        chunks.u32(kChunkIdBase + static_cast<std::uint32_t>(i)).u32(chunk_bytes(chunk));
    }
}

// A packet holds bytes of one part only.
std::uint32_t trailer_id(const GigeStreamState& s) {
    std::uint32_t count = 0;
    for (const std::size_t bytes : part_bytes(s)) count += pieces(bytes, s);
    return count + 1;
}

GigePacket packet_of(const GigeFrame& f, std::uint32_t id, gvsp::Status status) {
    const GigeStreamState& s = f.stream;
    const std::uint32_t last = trailer_id(s);
    gvsp::PacketHeader header{.status = status, .extended = s.long_ids(), .block = f.block, .packet = id};
    header.format = id == 0 ? gvsp::kLeader : id >= last ? gvsp::kTrailer : gvsp::kPayload;
    if (header.format == gvsp::kLeader) return leader_of(f, header);
    if (header.format == gvsp::kTrailer) return trailer_of(f, header);
    GigePacket p;
    const auto parts = part_bytes(s);
    std::size_t begin = 0, i = 0;
    std::uint8_t part = 0;         // among the parts present
    std::uint32_t place = id - 1;  // in the part
    for (; place >= pieces(parts[i], s); ++i) {
        place -= pieces(parts[i], s);
        begin += parts[i];
        if (parts[i] > 0) ++part;
    }
    const std::size_t from = begin + place * piece_bytes(s), end = begin + parts[i];
    if (s.multipart) header.format = gvsp::kMultipart;
    p.head_bytes = s.multipart ? gvsp::write_part_payload(header, part, from, p.head)
                               : gvsp::write_header(header, p.head);
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
