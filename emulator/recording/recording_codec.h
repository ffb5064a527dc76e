#pragma once
// The byte format of a recording (docs/recording.md). Pure functions.
//
//     file:   8 bytes "hilcrec" 01, then records
//     record: u32 length of the body, u32 CRC-32 of the body, body: u8 kind, fields
//
// Big-endian, like all of the program's formats. The first record is the header.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "emulator/recording/recording.h"

namespace hilcam {

inline constexpr std::array<std::uint8_t, 8> kRecordingMagic = {'h', 'i', 'l', 'c', 'r', 'e', 'c', 1};
inline constexpr std::size_t kRecordPrefixBytes = 8;
inline constexpr std::size_t kMaxRecordBytes = 512;        // largest body
inline constexpr std::size_t kMaxHeaderBytes = 16u << 20;  // largest body of the header

// Encodes the header with its length and CRC. Throws InputError for a scenario that exceeds the largest
// header.
std::vector<std::uint8_t> encode_header(const RecordingHeader& header);
// Encodes a record into a buffer of kRecordPrefixBytes + kMaxRecordBytes, and returns the number of bytes.
std::size_t encode_record(const Record& record, std::span<std::uint8_t> bytes);

// Decode bodies. They return nothing for invalid bytes: a wrong length, an unknown kind or enumerator, a
// number that is not finite.
std::optional<RecordingHeader> decode_header(std::span<const std::uint8_t> body);
std::optional<Record> decode_record(std::span<const std::uint8_t> body);

}  // namespace hilcam
