#include "io/packets/rmap.h"

#include <array>

#include "io/system/bytes.h"

namespace hilcam {
namespace {

constexpr std::uint8_t kRmapProtocol = 0x01;  // protocol identifier (ECSS-E-ST-50-51C)
// Bits of the instruction: a command, that writes.
constexpr unsigned kCommand = 0x40, kWrite = 0x20, kIncrement = 0x04;

constexpr std::array<std::uint8_t, 256> make_crc_table() {
    std::array<std::uint8_t, 256> table{};
    for (unsigned i = 0; i < 256; ++i) {
        unsigned value = i;
        for (int bit = 0; bit < 8; ++bit) value = value & 1u ? (value >> 1) ^ 0xE0u : value >> 1;
        table[i] = static_cast<std::uint8_t>(value);
    }
    return table;
}
constexpr std::array<std::uint8_t, 256> kCrcTable = make_crc_table();

}  // namespace

std::uint8_t rmap_crc(std::span<const std::uint8_t> bytes) {
    std::uint8_t crc = 0;
    for (const std::uint8_t byte : bytes) crc = kCrcTable[crc ^ byte];
    return crc;
}

void append_rmap_write(const RmapWrite& w, std::span<const std::uint8_t> data,
                       std::vector<std::uint8_t>& out) {
    HILCAM_CHECK(data.size() <= kRmapMostDataBytes);
    std::array<std::uint8_t, kRmapWriteHeaderBytes> header{};
    ByteWriter bytes(header);
    bytes.u8(w.target).u8(kRmapProtocol).u8(kCommand | kWrite | (w.increment ? kIncrement : 0)).u8(w.key);
    bytes.u8(w.initiator).u16(w.transaction).u8(w.extended_address).u32(w.address);
    bytes.u8(data.size() >> 16).u16(data.size());
    bytes.u8(rmap_crc(std::span(header).first(bytes.size())));
    out.insert(out.end(), header.begin(), header.end());
    out.insert(out.end(), data.begin(), data.end());
    out.push_back(rmap_crc(data));
}

}  // namespace hilcam
