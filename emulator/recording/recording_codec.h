#pragma once
// A recording's bytes (docs/recording.md). Pure functions.
//
//     file:   8 bytes "hilcrec" 01, then records
//     record: u32 length of the body, u32 CRC-32 of the body, body: u8 kind, fields
//
// Big-endian, as all of the program's formats. The first record is the header.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "emulator/recording/recording.h"

namespace hilcam {

inline constexpr std::array<std::uint8_t, 8> kRecordingMagic = {'h', 'i', 'l', 'c', 'r', 'e', 'c', 1};
inline constexpr std::size_t kRecordPrefixBytes = 8;
inline constexpr std::size_t kMaxRecordBytes = 512;        // of a body
inline constexpr std::size_t kMaxHeaderBytes = 16u << 20;  // of the header's

// With its length and CRC. Throws InputError when a scenario is longer than a header may be.
std::vector<std::uint8_t> encode_header(const RecordingHeader& header);
// The same for a record, into a buffer of kRecordPrefixBytes + kMaxRecordBytes; gives the number of bytes.
std::size_t encode_record(const Record& record, std::span<std::uint8_t> bytes);

// Bodies. Nothing for bytes that are none: wrong length, a kind or a word of a fixed list that does not
// exist, a number that is not finite.
std::optional<RecordingHeader> decode_header(std::span<const std::uint8_t> body);
std::optional<Record> decode_record(std::span<const std::uint8_t> body);

}  // namespace hilcam
