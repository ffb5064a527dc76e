// Any bytes are a recording that can be read to its last whole record and listed, or refused in one line; a
// record that was read gives the same bytes when it is written. Damage goes into bodies, whose CRCs are made
// right again: else hardly any would be looked at.

#include <algorithm>
#include <random>
#include <sstream>
#include <string>

#include "emulator/recording/recording_codec.h"
#include "emulator/recording/recording_reader.h"
#include "emulator/recording/recording_text.h"
#include "io/system/bytes.h"
#include "io/system/crc32.h"
#include "render/vocabulary/check.h"

using namespace hilcam;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string bytes(reinterpret_cast<const char*>(data), size);
    try {
        RecordingReader reader(std::make_unique<std::istringstream>(bytes), "fuzz");
        std::array<std::uint8_t, kRecordPrefixBytes + kMaxRecordBytes> again{};
        std::uint64_t before = reader.offset();
        for (Record record; reader.next(record); before = reader.offset()) {
            const std::size_t written = encode_record(record, again), was = reader.offset() - before;
            // Payloads of the wire have bytes that say nothing. Changes, triggers and frames of earlier programs
            // end before the fields that came later.
            const bool may_end_early = std::holds_alternative<RecordedChange>(record) ||
                                       std::holds_alternative<RecordedTrigger>(record) ||
                                       std::holds_alternative<RecordedFrame>(record);
            HILCAM_CHECK(written == was || (may_end_early && written > was));
            HILCAM_CHECK(
                decode_record(std::span(again).subspan(kRecordPrefixBytes, written - kRecordPrefixBytes)));
        }
        HILCAM_CHECK(reader.end() != RecordingEnd::kNone && reader.offset() <= size);
        HILCAM_CHECK(!reader.next(*std::make_unique<Record>()));
        RecordingReader listed(std::make_unique<std::istringstream>(bytes), "fuzz");
        list_recording(listed, [](const std::string& line) {
            HILCAM_CHECK(!line.empty() && line.find('\n') == std::string::npos);
        });
    } catch (const InputError& error) {
        HILCAM_CHECK(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
    return 0;
}

// Changes a few bytes of one record's body.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t,
                                               unsigned seed) {
    std::mt19937 random(seed);
    std::vector<std::pair<std::size_t, std::size_t>> bodies;  // place, length
    for (std::size_t at = kRecordingMagic.size(); at + kRecordPrefixBytes < size;) {
        const std::size_t length = ByteReader(std::span(data + at, 4)).u32();
        if (length == 0 || length > size - at - kRecordPrefixBytes) break;
        bodies.push_back({at + kRecordPrefixBytes, length});
        at += kRecordPrefixBytes + length;
    }
    if (bodies.empty()) return size;
    const auto [place, length] = bodies[random() % bodies.size()];
    for (std::size_t count = 1 + random() % 4; count > 0; --count)
        data[place + random() % length] = static_cast<std::uint8_t>(random());
    ByteWriter(std::span(data + place - 4, 4)).u32(crc32_of(std::span(data + place, length)));
    return size;
}
