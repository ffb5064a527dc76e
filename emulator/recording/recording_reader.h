#pragma once
// Reads a recording from front to back. The bytes are not trusted: reading ends after the last whole record
// before the first one that is damaged or cut off. Owner thread.

#include <cstdint>
#include <filesystem>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emulator/recording/recording.h"

namespace hilcam {

enum class RecordingEnd : std::uint8_t {
    kNone,     // more records follow
    kClean,    // the run ended here
    kCutOff,   // the file ends before the run's end
    kDamaged,  // a record has a wrong length, CRC or content
    kLoss,     // records are missing from here on (RecordedLoss)
};

class RecordingReader {
  public:
    // Throws InputError when the file cannot be read or does not begin like a recording.
    explicit RecordingReader(const std::filesystem::path& file);
    // Reads any stream; `name` stands for the file in messages.
    RecordingReader(std::unique_ptr<std::istream> in, std::string name);

    const RecordingHeader& header() const { return header_; }
    const std::string& name() const { return name_; }
    // Reads the next record; false at the end.
    bool next(Record& record);
    // Makes next() continue after lost records: for listings, not for replays.
    void pass_losses() { stop_at_loss_ = false; }
    RecordingEnd end() const { return end_; }
    // Returns the number of bytes read, all of whole records.
    std::uint64_t offset() const { return offset_; }
    // Describes the end for people.
    std::string end_text() const;

  private:
    std::optional<std::size_t> read_body(std::size_t most);

    std::unique_ptr<std::istream> in_;
    std::string name_;
    RecordingHeader header_;
    std::vector<std::uint8_t> body_;
    std::uint64_t offset_ = 0;
    RecordingEnd end_ = RecordingEnd::kNone;
    bool stop_at_loss_ = true;
};

}  // namespace hilcam
