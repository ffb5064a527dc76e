#include "io/v4l2/v4l2_metadata_row.h"

#include <algorithm>

#include "io/commands/ccsds.h"
#include "io/system/bytes.h"

namespace hilcam {
namespace {

constexpr std::uint32_t kRowMark = 0x48434D52;  // "HCMR"
constexpr std::uint16_t kRowVersion = 1;

}  // namespace

void write_metadata_row(const FrameRecord& r, std::span<std::uint8_t> row) {
    ByteWriter out(row);
    out.u32(kRowMark).u16(kRowVersion).u16(kMetadataBytes).u64(r.id);
    out.u64(static_cast<std::uint64_t>(r.exposure_mid.ns));
    out.u64(static_cast<std::uint64_t>(r.exposure_mid_monotonic_ns));
    out.f64(r.exposure_s).f64(r.gain_db).u32(r.pose_sequence).u32(r.trigger_sequence);
    out.u64(static_cast<std::uint64_t>(r.pose_time.ns)).u64(r.faults).u32(r.quality_level);
    out.u16(static_cast<std::uint64_t>(r.bits));
    out.u16(crc16(row.first(out.size())));
    std::fill(row.begin() + kMetadataBytes, row.end(), std::uint8_t{0});
}

std::optional<FrameRecord> read_metadata_row(std::span<const std::uint8_t> row) {
    if (row.size() < kMetadataBytes || crc16(row.first(kMetadataBytes)) != 0) return std::nullopt;
    ByteReader in(row);
    if (in.u32() != kRowMark || in.u16() != kRowVersion || in.u16() != kMetadataBytes) return std::nullopt;
    FrameRecord r;
    r.id = in.u64();
    r.exposure_mid.ns = in.i64();
    r.exposure_mid_monotonic_ns = in.i64();
    r.exposure_s = in.f64();
    r.gain_db = in.f64();
    r.pose_sequence = in.u32();
    r.trigger_sequence = in.u32();
    r.pose_time.ns = in.i64();
    r.faults = in.u64();
    r.quality_level = in.u32();
    r.bits = in.u16();
    return r;
}

}  // namespace hilcam
