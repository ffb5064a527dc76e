#include "io/packets/image_header.h"

#include "io/packets/cuc_time.h"
#include "io/system/bytes.h"

namespace hilcam {
namespace {

constexpr unsigned kReversedX = 1, kReversedY = 2, kCrc = 4;

}  // namespace

void write_image_header(const ImageFrame& f, const ImageSegment& s, std::span<std::uint8_t> bytes) {
    ByteWriter out(bytes.first(kImageHeaderBytes));
    write_cuc(f.exposure_mid, out);
    out.u8(kImageHeaderVersion).u8(static_cast<std::uint8_t>(f.payload)).u8(f.bits);
    out.u8((f.reverse_x ? kReversedX : 0) | (f.reverse_y ? kReversedY : 0) | (f.crc ? kCrc : 0));
    out.u8(f.binning_x).u8(f.binning_y);
    out.u16(f.width).u16(f.height).u16(f.offset_x).u16(f.offset_y);
    out.u16(s.first_row).u16(s.rows);
    out.u32(f.pixel_code).u64(f.frame).f64(f.exposure_s);
    out.u32(s.segment).u32(s.segments).u32(s.strip_offset).u32(s.strip_bytes);
    HILCAM_DCHECK(out.size() == kImageHeaderBytes);
}

}  // namespace hilcam
