// Pictures from the image packets of hilcam's output `packets` (docs/packets.md): one header to copy, C++17,
// without dependencies. Apache 2.0, as hilcam.
//
//   PacketSplitter   finds packets in a stream of bytes (a UART, TCP); a datagram is a packet by itself
//   read_packet()    checks a packet and reads its headers
//   PictureAssembler puts the packets of a frame together, whatever is lost, doubled or out of order
//   PictureReceiver  all of these: bytes in, pictures out
//
// All memory is taken by the constructors. Functions neither throw nor allocate after that, and touch nothing
// outside what they are given. Not for several threads at once.

#ifndef HILCAM_IMAGE_HPP
#define HILCAM_IMAGE_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace hilcam_image {

// CCSDS 133.0-B-2: the primary header; 4.1.3.5.3: a data field has 1 to 65,536 bytes.
constexpr std::size_t kPrimaryBytes = 6, kImageHeaderBytes = 64, kCrcBytes = 2;
constexpr std::size_t kMostPacketBytes = kPrimaryBytes + 65536;

enum class Payload : std::uint8_t {
    kRawLittleEndian = 0,  // 16 bits a pixel
    kRawBigEndian = 1,
    kPacked = 2,    // the DN's bits one after another, least significant first
    kCcsds121 = 3,  // CCSDS 121.0-B-3
    kJpegLs = 4,
    kJpeg2000 = 5,
};

struct Packet {
    std::uint16_t apid = 0, sequence_count = 0;
    std::int64_t tai_ns = 0;  // middle of the exposure, since 1970-01-01T00:00:00 TAI
    Payload payload = Payload::kRawLittleEndian;
    std::uint8_t bits = 0;  // significant bits of a pixel
    bool reverse_x = false, reverse_y = false;
    std::uint8_t binning_x = 1, binning_y = 1;
    std::uint16_t width = 0, height = 0, offset_x = 0, offset_y = 0;  // px
    std::uint16_t first_row = 0, rows = 0;                            // of the strip that the data belong to
    std::uint32_t pixel_code = 0;                                     // PFNC
    std::uint64_t frame = 0;                                          // id, from 1
    double exposure_s = 0;
    std::uint32_t segment = 0, segments = 0;  // of the frame, from 0
    std::uint32_t strip_offset = 0, strip_bytes = 0;
    const std::uint8_t* data = nullptr;  // inside the packet's bytes
    std::size_t data_bytes = 0;
};

enum class Fault : std::uint8_t {
    kNone,
    kLength,    // shorter than its headers, or not as long as its header says
    kPrimary,   // another version or type, or without a secondary header
    kVersion,   // another version of the image header, or another time code
    kCrc,       // the CRC is not that of the bytes
    kGeometry,  // rows, segments or offsets outside the frame or strip
};

namespace detail {

inline std::uint64_t big_endian(const std::uint8_t* bytes, int count) {
    std::uint64_t value = 0;
    for (int i = 0; i < count; ++i) value = value << 8 | bytes[i];
    return value;
}
inline std::uint16_t u16(const std::uint8_t* bytes) {
    return static_cast<std::uint16_t>(big_endian(bytes, 2));
}
inline std::uint32_t u32(const std::uint8_t* bytes) {
    return static_cast<std::uint32_t>(big_endian(bytes, 4));
}

// CRC-16/CCITT-FALSE (CCSDS 132.0-B-3, 4.1.6.2). Over bytes that end with their own CRC it is 0.
inline std::uint16_t crc16(const std::uint8_t* bytes, std::size_t count) {
    std::uint32_t crc = 0xFFFF;
    for (std::size_t i = 0; i < count; ++i) {
        crc ^= static_cast<std::uint32_t>(bytes[i]) << 8;
        for (int bit = 0; bit < 8; ++bit)
            crc = (crc & 0x8000u) != 0 ? (crc << 1 ^ 0x1021u) & 0xFFFFu : crc << 1 & 0xFFFFu;
    }
    return static_cast<std::uint16_t>(crc);
}

// CUC with the preamble 0x9F04: seconds and 2^-32 s since 1958-01-01 TAI (CCSDS 301.0-B-4, 3.2).
constexpr std::uint16_t kCucPreamble = 0x9F04;
inline std::int64_t tai_ns_of_cuc(std::uint32_t seconds, std::uint32_t fraction) {
    constexpr std::int64_t kFrom1958To1970_s = 4383LL * 86400;
    const std::uint64_t ns = (static_cast<std::uint64_t>(fraction) * 1000000000u + (1u << 31)) >> 32;
    return (static_cast<std::int64_t>(seconds) - kFrom1958To1970_s) * 1000000000 +
           static_cast<std::int64_t>(ns);
}

inline bool fits(const Packet& p) {
    return p.width > 0 && p.height > 0 && p.rows > 0 && p.bits >= 1 && p.bits <= 16 &&
           p.segment < p.segments && std::uint32_t{p.first_row} + p.rows <= p.height && p.data_bytes > 0 &&
           p.strip_offset <= p.strip_bytes && p.data_bytes <= p.strip_bytes - p.strip_offset;
}

}  // namespace detail

// Returns the length of the packet that begins here; 0 when fewer than its primary header's bytes are there.
inline std::size_t packet_bytes(const std::uint8_t* bytes, std::size_t count) {
    return count < kPrimaryBytes ? 0 : kPrimaryBytes + 1 + detail::u16(bytes + 4);
}

// Reads one whole packet. `packet` is valid only for kNone, and as long as the bytes stay.
inline Fault read_packet(const std::uint8_t* bytes, std::size_t count, Packet& packet) {
    using detail::u16;
    using detail::u32;
    if (count < kPrimaryBytes + kImageHeaderBytes || packet_bytes(bytes, count) != count)
        return Fault::kLength;
    // Version 0, telemetry, with a secondary header.
    if ((bytes[0] & 0xF8) != 0x08) return Fault::kPrimary;
    const std::uint8_t* const h = bytes + kPrimaryBytes;
    constexpr std::uint8_t kVersion = 1;
    if (u16(h) != detail::kCucPreamble || h[10] != kVersion || h[11] > 5) return Fault::kVersion;
    const bool has_crc = (h[13] & 4) != 0;
    const std::size_t tail = has_crc ? kCrcBytes : 0;
    if (count < kPrimaryBytes + kImageHeaderBytes + tail) return Fault::kLength;
    if (has_crc && detail::crc16(bytes, count) != 0) return Fault::kCrc;

    packet.apid = u16(bytes) & 0x7FF;
    packet.sequence_count = u16(bytes + 2) & 0x3FFF;
    packet.tai_ns = detail::tai_ns_of_cuc(u32(h + 2), u32(h + 6));
    packet.payload = static_cast<Payload>(h[11]);
    packet.bits = h[12];
    packet.reverse_x = (h[13] & 1) != 0, packet.reverse_y = (h[13] & 2) != 0;
    packet.binning_x = h[14], packet.binning_y = h[15];
    packet.width = u16(h + 16), packet.height = u16(h + 18);
    packet.offset_x = u16(h + 20), packet.offset_y = u16(h + 22);
    packet.first_row = u16(h + 24), packet.rows = u16(h + 26);
    packet.pixel_code = u32(h + 28);
    packet.frame = detail::big_endian(h + 32, 8);
    const std::uint64_t exposure = detail::big_endian(h + 40, 8);
    std::memcpy(&packet.exposure_s, &exposure, sizeof exposure);  // IEEE 754 binary64
    packet.segment = u32(h + 48), packet.segments = u32(h + 52);
    packet.strip_offset = u32(h + 56), packet.strip_bytes = u32(h + 60);
    packet.data = h + kImageHeaderBytes;
    packet.data_bytes = count - kPrimaryBytes - kImageHeaderBytes - tail;
    return detail::fits(packet) ? Fault::kNone : Fault::kGeometry;
}

// Finds packets of one APID in a stream that may begin anywhere and lack bytes. What does not begin with that
// APID's primary header is skipped byte by byte; after a packet that read_packet() refuses, call skip() to
// look for the next one inside it.
class PacketSplitter {
  public:
    explicit PacketSplitter(std::uint16_t apid) : apid_(apid), bytes_(2 * kMostPacketBytes) {}

    // Takes bytes, as many as there is room for, and returns how many.
    std::size_t put(const std::uint8_t* bytes, std::size_t count) {
        if (begin_ > 0) std::memmove(bytes_.data(), bytes_.data() + begin_, end_ - begin_);
        end_ -= begin_, begin_ = 0;
        const std::size_t room = std::min(count, bytes_.size() - end_);
        if (room > 0) std::memcpy(bytes_.data() + end_, bytes, room);
        end_ += room;
        return room;
    }
    // Returns the next whole packet's bytes, valid until the next put(); null when more bytes are needed.
    const std::uint8_t* next(std::size_t& count) {
        while (end_ - begin_ >= kPrimaryBytes) {
            const std::uint8_t* const at = bytes_.data() + begin_;
            if (detail::u16(at) != (0x0800 | apid_)) {
                ++begin_, ++skipped_;
                continue;
            }
            count = packet_bytes(at, end_ - begin_);
            if (count > end_ - begin_) return nullptr;
            begin_ += last_ = count;
            return at;
        }
        return nullptr;
    }
    // Goes back into the packet that next() returned last: only its first byte is skipped. Before put().
    void skip() {
        if (last_ == 0) return;
        begin_ -= last_ - 1;
        last_ = 0, ++skipped_;
    }
    std::uint64_t skipped_bytes() const { return skipped_; }

  private:
    std::uint16_t apid_;
    std::vector<std::uint8_t> bytes_;
    std::size_t begin_ = 0, end_ = 0, last_ = 0;
    std::uint64_t skipped_ = 0;
};

// A frame, whole or in parts. Pixels that did not come are 0, and their `valid` is 0.
struct Picture {
    Packet header;                          // of its first packet; its data are not valid
    const std::uint16_t* pixels = nullptr;  // width x height DN, row by row
    const std::uint8_t* valid = nullptr;    // as many bytes: 1 where the pixel came
    std::size_t missing_pixels = 0;
    std::uint32_t missing_packets = 0;
    bool is_whole() const { return missing_pixels == 0; }
};

// Decompresses a strip whose bytes have all come into rows x width DN. Returns false when it cannot.
using StripDecoder = bool (*)(void* context, const Packet& header, const std::uint8_t* bytes,
                              std::size_t count, std::uint16_t* pixels);

class PictureAssembler {
  public:
    // most_pixels: of the largest frame. decoder: for compressed strips; null: they are missing pixels.
    explicit PictureAssembler(std::size_t most_pixels, StripDecoder decoder = nullptr,
                              void* context = nullptr)
        : decoder_(decoder),
          context_(context),
          bytes_(2 * most_pixels),
          came_(2 * most_pixels),
          pixels_(most_pixels),
          valid_(most_pixels),
          segments_(kMostSegments) {}

    enum class Taken : std::uint8_t {
        kYes,
        kAgain,   // this segment had come already
        kLate,    // of an earlier frame than the one at hand
        kTooBig,  // of a frame with more pixels, segments or bytes than there is room for
        kUnlike,  // its header does not fit to the frame's earlier ones
    };
    // Takes a packet. When it belongs to a later frame than the one at hand, `finished` is set and the packet
    // is not taken: call finish(), and take() again. After 64 late packets in a row the sender has begun anew.
    Taken take(const Packet& packet, bool& finished) {
        finished = false;
        const bool is_late = open_ ? packet.frame < head_.frame : packet.frame <= last_frame_;
        late_ = is_late ? late_ + 1 : 0;
        if (is_late && late_ < kNewRun) return Taken::kLate;
        if (open_ && packet.frame != head_.frame) {
            finished = true;
            return Taken::kYes;
        }
        if (is_late) late_ = 0;
        if (!has_room_for(packet)) return Taken::kTooBig;
        if (!open_) begin(packet);
        if (!is_alike(packet)) return Taken::kUnlike;
        if (segments_[packet.segment] != 0) return Taken::kAgain;
        segments_[packet.segment] = 1;
        ++segments_came_;
        keep(packet);
        return Taken::kYes;
    }
    // True when all packets of the frame at hand have come.
    bool is_complete() const { return open_ && segments_came_ == head_.segments; }
    bool is_open() const { return open_; }
    // Ends the frame at hand, whole or not, and returns it; valid until the next take(). Without one, the
    // picture has no pixels.
    Picture finish() {
        Picture picture;
        if (!open_) return picture;
        open_ = false;
        last_frame_ = head_.frame;
        std::fill_n(pixels_.begin(), pixel_count(), std::uint16_t{0});
        std::fill_n(valid_.begin(), pixel_count(), std::uint8_t{0});
        // A strip begins at a row where its first byte's mark is.
        for (std::size_t row = 0; row < head_.height; ++row)
            if (strip_rows_[row] > 0) decode_strip(row, strip_rows_[row], strip_bytes_[row]);
        picture.header = head_;
        picture.header.data = nullptr, picture.header.data_bytes = 0;
        picture.pixels = pixels_.data(), picture.valid = valid_.data();
        picture.missing_packets = head_.segments - segments_came_;
        for (std::size_t i = 0; i < pixel_count(); ++i)
            if (valid_[i] == 0) ++picture.missing_pixels;
        return picture;
    }

  private:
    static constexpr std::size_t kMostSegments = 1u << 20;
    static constexpr std::uint32_t kNewRun = 64;

    std::size_t pixel_count() const { return std::size_t{head_.width} * head_.height; }
    // Bytes for a strip's payload: those of its rows with 16 bits a pixel.
    std::size_t place_of_row(std::size_t row) const { return 2 * row * head_.width; }
    bool has_room_for(const Packet& p) const {
        const std::size_t row_bytes = 2 * std::size_t{p.width};
        return std::size_t{p.width} * p.height <= pixels_.size() && p.segments <= kMostSegments &&
               p.strip_bytes <= row_bytes * p.rows;
    }
    void begin(const Packet& packet) {
        head_ = packet;
        open_ = true;
        segments_came_ = 0;
        std::fill_n(segments_.begin(), packet.segments, std::uint8_t{0});
        std::fill_n(came_.begin(), 2 * pixel_count(), std::uint8_t{0});
        std::fill_n(strip_rows_.begin(), head_.height, std::uint16_t{0});
    }
    bool is_alike(const Packet& p) const {
        const bool same_frame = p.width == head_.width && p.height == head_.height &&
                                p.payload == head_.payload && p.bits == head_.bits &&
                                p.segments == head_.segments && p.tai_ns == head_.tai_ns;
        const std::uint16_t rows = strip_rows_[p.first_row];
        if (!same_frame || (rows > 0 && (rows != p.rows || strip_bytes_[p.first_row] != p.strip_bytes)))
            return false;
        // Strips do not overlap.
        if (rows == 0)
            for (std::size_t row = 0; row < head_.height; ++row)
                if (strip_rows_[row] > 0 && row < std::size_t{p.first_row} + p.rows &&
                    p.first_row < row + strip_rows_[row])
                    return false;
        return true;
    }
    void keep(const Packet& p) {
        strip_rows_[p.first_row] = p.rows, strip_bytes_[p.first_row] = p.strip_bytes;
        const std::size_t at = place_of_row(p.first_row) + p.strip_offset;
        std::memcpy(bytes_.data() + at, p.data, p.data_bytes);
        std::memset(came_.data() + at, 1, p.data_bytes);
    }
    void decode_strip(std::size_t row, std::size_t rows, std::size_t count) {
        const std::size_t from = place_of_row(row);
        const std::uint8_t* const bytes = bytes_.data() + from;
        const std::uint8_t* const came = came_.data() + from;
        const std::size_t first = row * head_.width, pixels = rows * head_.width;
        if (head_.payload <= Payload::kPacked) {
            const std::size_t width = head_.payload == Payload::kPacked ? head_.bits : 16;
            for (std::size_t i = 0; i < pixels; ++i)
                valid_[first + i] =
                    take_pixel(bytes, came, count, i * width, width, pixels_[first + i]) ? 1 : 0;
            return;
        }
        if (decoder_ == nullptr ||
            std::count(came, came + count, std::uint8_t{1}) != static_cast<std::ptrdiff_t>(count))
            return;
        Packet strip = head_;
        strip.first_row = static_cast<std::uint16_t>(row), strip.rows = static_cast<std::uint16_t>(rows);
        if (decoder_(context_, strip, bytes, count, pixels_.data() + first))
            std::fill_n(valid_.begin() + static_cast<std::ptrdiff_t>(first), pixels, std::uint8_t{1});
        else
            std::fill_n(pixels_.begin() + static_cast<std::ptrdiff_t>(first), pixels, std::uint16_t{0});
    }
    // Reads a pixel of `width` bits from a bit of a strip. Returns false when one of its bytes did not come.
    bool take_pixel(const std::uint8_t* bytes, const std::uint8_t* came, std::size_t count, std::size_t bit,
                    std::size_t width, std::uint16_t& pixel) const {
        const std::size_t first = bit / 8, last = (bit + width - 1) / 8;
        if (last >= count) return false;
        std::uint32_t value = 0;
        for (std::size_t i = first; i <= last; ++i) {
            if (came[i] == 0) return false;
            value |= static_cast<std::uint32_t>(bytes[i]) << (8 * (i - first));
        }
        if (head_.payload == Payload::kRawBigEndian) value = (value & 0xFF) << 8 | value >> 8;
        pixel = static_cast<std::uint16_t>(value >> (bit % 8) & ((1u << width) - 1));
        return true;
    }

    StripDecoder decoder_;
    void* context_;
    std::vector<std::uint8_t> bytes_, came_;  // payloads of all strips, and which of their bytes came
    std::vector<std::uint16_t> pixels_;
    std::vector<std::uint8_t> valid_, segments_;
    std::vector<std::uint16_t> strip_rows_ = std::vector<std::uint16_t>(65536);  // 0: no strip begins there
    std::vector<std::uint32_t> strip_bytes_ = std::vector<std::uint32_t>(65536);
    Packet head_;
    bool open_ = false;
    std::uint32_t segments_came_ = 0;
    std::uint64_t last_frame_ = 0;  // ids of frames begin at 1
    std::uint32_t late_ = 0;        // late packets in a row
};

// Bytes of a stream or datagrams in, pictures out.
class PictureReceiver {
  public:
    PictureReceiver(std::uint16_t apid, std::size_t most_pixels, StripDecoder decoder = nullptr,
                    void* context = nullptr)
        : splitter_(apid), assembler_(most_pixels, decoder, context) {}

    // Called with each picture, which is valid during the call: whole ones when their last packet comes,
    // others when a later frame's first packet does.
    using OnPicture = void (*)(void* context, const Picture& picture);
    struct Counts {
        std::uint64_t packets = 0;  // good ones
        std::uint64_t refused = 0;  // by read_packet()
        std::uint64_t unused = 0;   // doubled, late, too big, or unlike their frame's others
        std::uint64_t skipped_bytes = 0;
    };

    void take(const std::uint8_t* bytes, std::size_t count, OnPicture on_picture, void* context) {
        while (count > 0) {
            const std::size_t taken = splitter_.put(bytes, count);
            bytes += taken, count -= taken;
            std::size_t length = 0;
            while (const std::uint8_t* const found = splitter_.next(length))
                take_packet(found, length, on_picture, context);
        }
        counts_.skipped_bytes = splitter_.skipped_bytes();
    }
    const Counts& counts() const { return counts_; }

  private:
    void take_packet(const std::uint8_t* bytes, std::size_t count, OnPicture on_picture, void* context) {
        Packet packet;
        if (read_packet(bytes, count, packet) != Fault::kNone) {
            ++counts_.refused;
            return splitter_.skip();
        }
        ++counts_.packets;
        bool finished = false;
        auto taken = assembler_.take(packet, finished);
        if (finished) {
            on_picture(context, assembler_.finish());
            taken = assembler_.take(packet, finished);
        }
        if (taken != PictureAssembler::Taken::kYes) ++counts_.unused;
        if (assembler_.is_complete()) on_picture(context, assembler_.finish());
    }

    PacketSplitter splitter_;
    PictureAssembler assembler_;
    Counts counts_;
};

}  // namespace hilcam_image

#endif
