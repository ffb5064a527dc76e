#pragma once
// Image packets by docs/packets.md, written by hand for tests of their readers.

#include <cstdint>
#include <cstring>
#include <vector>

#include "tools/image_packets/hilcam_image.hpp"

namespace hilcam_image {

inline void put(std::vector<std::uint8_t>& out, std::uint64_t value, int bytes) {
    for (int i = bytes - 1; i >= 0; --i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i) & 0xFF));
}

// The packet of a header and its data, with a CRC or without. `p.data` is not used.
inline std::vector<std::uint8_t> packet_of(const Packet& p, const std::vector<std::uint8_t>& data, bool crc) {
    std::vector<std::uint8_t> out;
    const unsigned flags = (p.segment == 0 ? 1u : 0u) | (p.segment + 1 == p.segments ? 2u : 0u);
    put(out, 0x0800u | p.apid, 2);
    put(out, flags << 14 | p.sequence_count, 2);
    put(out, 64 + data.size() + (crc ? 2 : 0) - 1, 2);
    put(out, 0x9F04, 2);
    const std::int64_t since_1958_ns = p.tai_ns + 4383LL * 86400 * 1000000000;
    put(out, static_cast<std::uint64_t>(since_1958_ns / 1000000000), 4);
    // Rounded up, so that a whole number of nanoseconds comes back.
    put(out, ((static_cast<std::uint64_t>(since_1958_ns % 1000000000) << 32) + 999999999) / 1000000000, 4);
    put(out, 1, 1), put(out, static_cast<std::uint8_t>(p.payload), 1), put(out, p.bits, 1);
    put(out, (p.reverse_x ? 1u : 0u) | (p.reverse_y ? 2u : 0u) | (crc ? 4u : 0u), 1);
    put(out, p.binning_x, 1), put(out, p.binning_y, 1);
    for (const std::uint16_t v : {p.width, p.height, p.offset_x, p.offset_y, p.first_row, p.rows})
        put(out, v, 2);
    put(out, p.pixel_code, 4), put(out, p.frame, 8);
    std::uint64_t exposure = 0;
    std::memcpy(&exposure, &p.exposure_s, sizeof exposure);
    put(out, exposure, 8);
    for (const std::uint32_t v : {p.segment, p.segments, p.strip_offset, p.strip_bytes}) put(out, v, 4);
    out.insert(out.end(), data.begin(), data.end());
    if (crc) put(out, detail::crc16(out.data(), out.size()), 2);
    return out;
}

inline std::vector<std::uint8_t> payload_of(const std::vector<std::uint16_t>& pixels, Payload payload,
                                            int bits) {
    std::vector<std::uint8_t> out;
    std::uint32_t kept = 0;
    int count = 0;
    for (const std::uint16_t dn : pixels) {
        if (payload == Payload::kRawBigEndian) {
            put(out, dn, 2);
            continue;
        }
        const int width = payload == Payload::kPacked ? bits : 16;
        kept |= static_cast<std::uint32_t>(dn) << count;
        for (count += width; count >= 8; count -= 8, kept >>= 8) out.push_back(kept & 0xFF);
    }
    if (count > 0) out.push_back(kept & 0xFF);
    return out;
}

struct Shape {
    std::uint16_t width = 37, height = 23, strip_rows = 5;
    Payload payload = Payload::kRawLittleEndian;
    std::uint8_t bits = 12;
    std::size_t data_bytes = 61;  // of a packet; odd, so that pixels are cut
    bool crc = true;
};

// All packets of a frame, in their order.
inline std::vector<std::vector<std::uint8_t>> packets_of(const std::vector<std::uint16_t>& pixels,
                                                         const Shape& s, std::uint64_t frame,
                                                         std::uint16_t& count) {
    std::vector<std::pair<Packet, std::vector<std::uint8_t>>> parts;
    for (unsigned row = 0; row < s.height; row += s.strip_rows) {
        Packet p;
        p.apid = 0x110, p.tai_ns = 1774015237000000000 + static_cast<std::int64_t>(frame) * 100000001;
        p.payload = s.payload, p.bits = s.bits, p.width = s.width, p.height = s.height;
        p.pixel_code = 0x01100005, p.frame = frame, p.exposure_s = 0.00015;
        p.first_row = static_cast<std::uint16_t>(row);
        p.rows = static_cast<std::uint16_t>(std::min<unsigned>(s.strip_rows, s.height - row));
        const auto first = pixels.begin() + static_cast<std::ptrdiff_t>(row) * s.width;
        const auto bytes = payload_of({first, first + std::ptrdiff_t{p.rows} * s.width}, s.payload, s.bits);
        p.strip_bytes = static_cast<std::uint32_t>(bytes.size());
        for (std::size_t at = 0; at < bytes.size(); at += s.data_bytes) {
            p.strip_offset = static_cast<std::uint32_t>(at);
            const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(at);
            const auto size = static_cast<std::ptrdiff_t>(std::min(s.data_bytes, bytes.size() - at));
            parts.push_back({p, {from, from + size}});
        }
    }
    std::vector<std::vector<std::uint8_t>> out;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        Packet& p = parts[i].first;
        p.segment = static_cast<std::uint32_t>(i), p.segments = static_cast<std::uint32_t>(parts.size());
        p.sequence_count = count++ & 0x3FFF;
        out.push_back(packet_of(p, parts[i].second, s.crc));
    }
    return out;
}

}  // namespace hilcam_image
