#include "io/packets/image_segmenter.h"

#include <algorithm>

#include "io/system/bytes.h"

namespace hilcam {
namespace {

constexpr std::size_t kHeadBytes = SpacePacketHeader::kBytes + kImageHeaderBytes;

// CCSDS 133.0-B-2, 4.1.3.4.2.2.
constexpr unsigned kContinuation = 0, kFirst = 1, kLast = 2;

std::uint8_t sequence_flags(std::uint32_t segment, std::uint32_t segments) {
    const unsigned first = segment == 0 ? kFirst : kContinuation;
    const unsigned last = segment + 1 == segments ? kLast : kContinuation;
    return static_cast<std::uint8_t>(first | last);
}

}  // namespace

ImageSegmenter::ImageSegmenter(std::uint16_t apid, std::size_t packet_bytes, bool crc)
    : apid_(apid), crc_(crc), packet_(packet_bytes) {
    HILCAM_CHECK(packet_bytes > kHeadBytes + kCrcBytes && packet_bytes <= kMostPacketBytes);
}

std::size_t ImageSegmenter::data_bytes() const {
    return packet_.size() - kHeadBytes - (crc_ ? kCrcBytes : 0);
}

void ImageSegmenter::begin(const ImageFrame& frame, std::span<const std::uint8_t> payload,
                           std::span<const StripPayload> strips) {
    frame_ = frame, payload_ = payload, strips_ = strips;
    frame_.crc = crc_;
    segment_ = segments_ = 0;
    strip_ = offset_ = 0;
    for (const StripPayload& strip : strips)
        segments_ += static_cast<std::uint32_t>((strip.bytes + data_bytes() - 1) / data_bytes());
}

std::span<const std::uint8_t> ImageSegmenter::next() {
    if (segment_ == segments_) return {};
    const StripPayload& strip = strips_[strip_];
    const std::size_t bytes = std::min(data_bytes(), strip.bytes - offset_);
    const SpacePacketHeader header{
        .apid = apid_,
        .sequence_flags = sequence_flags(segment_, segments_),
        .count = count_,
        .data_length = static_cast<std::uint16_t>(kImageHeaderBytes + bytes + (crc_ ? kCrcBytes : 0) - 1)};
    const std::span<std::uint8_t> packet = std::span(packet_).first(header.total_bytes());
    write_packet_header(header, packet);
    write_image_header(frame_,
                       {.first_row = strip.first_row,
                        .rows = strip.rows,
                        .segment = segment_,
                        .segments = segments_,
                        .strip_offset = static_cast<std::uint32_t>(offset_),
                        .strip_bytes = static_cast<std::uint32_t>(strip.bytes)},
                       packet.subspan(SpacePacketHeader::kBytes));
    std::copy_n(payload_.begin() + static_cast<std::ptrdiff_t>(strip.begin + offset_), bytes,
                packet.begin() + kHeadBytes);
    if (crc_) {
        const std::size_t covered = packet.size() - kCrcBytes;
        ByteWriter(packet.subspan(covered)).u16(crc16(packet.first(covered)));
    }
    count_ = (count_ + 1) & 0x3FFF;
    ++segment_;
    offset_ += bytes;
    if (offset_ == strip.bytes) ++strip_, offset_ = 0;
    return packet;
}

void ImageSegmenter::skip_rest() {
    count_ = static_cast<std::uint16_t>((count_ + segments_ - segment_) & 0x3FFF);
    segment_ = segments_;
}

}  // namespace hilcam
