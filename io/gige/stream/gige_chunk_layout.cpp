#include "io/gige/stream/gige_chunk_layout.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "io/system/bytes.h"

namespace hilcam {
namespace {

constexpr std::size_t kTagBytes = 8;  // id and length, behind the data

// The entries of ChunkSelector that a vendor's chunks can hold.
struct Name {
    std::string_view name;
    Chunk chunk;
};
constexpr Name kNames[] = {
    {"FrameID", Chunk::kFrameId},
    {"Timestamp", Chunk::kTimestamp},
    {"ExposureTime", Chunk::kExposureTime},
    {"Gain", Chunk::kGain},
    {"BlackLevel", Chunk::kBlackLevel},
    {"OffsetX", Chunk::kOffsetX},
    {"OffsetY", Chunk::kOffsetY},
    {"Width", Chunk::kWidth},
    {"Height", Chunk::kHeight},
    {"PixelFormat", Chunk::kPixelFormat},
};

// Numbers of 64 bits have no place in a double.
std::uint64_t whole_of(Chunk chunk, const FrameRecord& r, const GigeStreamState& s, BayerPattern seen,
                       std::uint64_t timestamp_ns) {
    switch (chunk) {
        case Chunk::kFrameId:
            return r.id;
        case Chunk::kTimestamp:
            return timestamp_ns;
        case Chunk::kOffsetX:
            return s.offset_x;
        case Chunk::kOffsetY:
            return s.offset_y;
        case Chunk::kWidth:
            return s.width;
        case Chunk::kHeight:
            return s.height;
        case Chunk::kPixelFormat:
            return pfnc_code(s.format, seen);
        default:
            return 0;
    }
}

double real_of(Chunk chunk, const FrameRecord& r, std::uint64_t whole) {
    switch (chunk) {
        case Chunk::kExposureTime:
            return r.exposure_s * 1e6;
        case Chunk::kGain:
            return r.gain_db;
        case Chunk::kBlackLevel:
            return r.black_level_dn;
        default:
            return static_cast<double>(whole);
    }
}

bool is_real(Chunk chunk) {
    return chunk == Chunk::kExposureTime || chunk == Chunk::kGain || chunk == Chunk::kBlackLevel;
}

std::uint64_t bits_for(const GigeChunkLayout::Field& f, const FrameRecord& r, std::uint64_t whole) {
    if (!f.codes.empty()) {
        for (const auto& [code, bits] : f.codes)
            if (code == whole) return bits;
        return 0;
    }
    const double scale = f.formula.scale;
    const bool halves = f.formula.kind == RegisterFormula::Kind::kLinear && f.formula.offset == 0 &&
                        scale >= 1 && scale < 1e18 && scale == std::floor(scale);
    // A long number may be in two registers, each with the bits that the other has not.
    if (!is_real(f.chunk) && halves) return whole / static_cast<std::uint64_t>(scale);
    return bits_of(f.place, f.formula.raw(real_of(f.chunk, r, whole)));
}

}  // namespace

std::size_t GigeChunkLayout::bytes(std::uint32_t enabled) const {
    std::size_t sum = kTagBytes;
    for (const Part& part : parts)
        if (part.chunks & enabled) sum += part.bytes + kTagBytes;
    return sum;
}

std::size_t chunk_layout_bytes(const GigeChunkLayout& layout, std::uint32_t enabled) {
    return layout.bytes(enabled);
}

GigeChunkLayout chunk_layout_of(const FaceTable& table, BayerPattern pattern) {
    GigeChunkLayout layout;
    layout.image_id = table.image_chunk_id;
    for (const FaceChunk& chunk : table.chunks) {
        GigeChunkLayout::Part part{.id = chunk.id, .bytes = chunk.bytes};
        for (const FaceChunkField& field : chunk.fields) {
            const auto* const known = std::find_if(std::begin(kNames), std::end(kNames),
                                                   [&](const Name& n) { return n.name == field.chunk; });
            if (known == std::end(kNames)) continue;  // a newer tool's
            part.chunks |= 1u << static_cast<unsigned>(known->chunk);
            GigeChunkLayout::Field& f = part.fields.emplace_back(
                GigeChunkLayout::Field{known->chunk, field.field, field.formula, {}});
            for (const FaceValue& value : field.values)
                for (const WireFormat format : formats_of(pattern))
                    if (pfnc_name(format, pattern) == value.entry)
                        f.codes.emplace_back(pfnc_code(format, pattern), value.raw);
        }
        if (!part.fields.empty()) layout.parts.push_back(std::move(part));
    }
    return layout;
}

void write_chunk_layout(const GigeChunkLayout& layout, const FrameRecord& record, const GigeStreamState& s,
                        BayerPattern seen, std::uint64_t timestamp_ns, std::size_t image_bytes,
                        std::span<std::uint8_t> out) {
    std::fill(out.begin(), out.end(), std::uint8_t{0});
    const auto tag = [&out](std::uint32_t id, std::size_t bytes) {
        ByteWriter(out.first(kTagBytes)).u32(id).u32(bytes);
        out = out.subspan(kTagBytes);
    };
    tag(layout.image_id, image_bytes);
    for (const GigeChunkLayout::Part& part : layout.parts) {
        if (!(part.chunks & s.chunks)) continue;
        for (const GigeChunkLayout::Field& f : part.fields)
            put_bits(f.place, bits_for(f, record, whole_of(f.chunk, record, s, seen, timestamp_ns)),
                     out.subspan(f.place.address, f.place.bytes));
        out = out.subspan(part.bytes);
        tag(part.id, part.bytes);
    }
}

}  // namespace hilcam
