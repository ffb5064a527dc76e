#pragma once
// Reads a recording from front to back. Bytes are not trusted: whatever they are, it ends at the last whole
// record before the first that is damaged or cut off. Owner thread.

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
    kNone,     // there is more
    kClean,    // the run ended there
    kCutOff,   // the file ends without the run's end
    kDamaged,  // a record's length or CRC is wrong, or it says nothing that can be
    kLoss,     // records are missing behind it (RecordedLoss)
};

class RecordingReader {
  public:
    // Throws InputError when the file cannot be read or does not begin as a recording does.
    explicit RecordingReader(const std::filesystem::path& file);
    // The same of any bytes; `name` stands for the file in messages.
    RecordingReader(std::unique_ptr<std::istream> in, std::string name);

    const RecordingHeader& header() const { return header_; }
    const std::string& name() const { return name_; }
    // The next record; false at the end.
    bool next(Record& record);
    // Goes on behind a loss: for lists, not for replays.
    void pass_losses() { stop_at_loss_ = false; }
    RecordingEnd end() const { return end_; }
    // Bytes read, all of them whole records.
    std::uint64_t offset() const { return offset_; }
    // Says what the end is, for people.
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
