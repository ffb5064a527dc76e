#include "emulator/recording/recording_reader.h"

#include <algorithm>
#include <array>
#include <limits>

#include "emulator/recording/recording_codec.h"
#include "io/system/bytes.h"
#include "io/system/crc32.h"
#include "io/system/input_file.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// A recording is read record by record, so it may be of any length.
const InputKind kRecordingFile{std::numeric_limits<std::int64_t>::max(),
                               "a recording of hilcam run --record"};

}  // namespace

RecordingReader::RecordingReader(const std::filesystem::path& file)
    : RecordingReader(std::make_unique<InputStream>(file, kRecordingFile), file.string()) {}

RecordingReader::RecordingReader(std::unique_ptr<std::istream> in, std::string name)
    : in_(std::move(in)), name_(std::move(name)) {
    std::array<std::uint8_t, kRecordingMagic.size()> magic{};
    in_->read(reinterpret_cast<char*>(magic.data()), static_cast<std::streamsize>(magic.size()));
    const auto version_at = magic.end() - 1;
    if (!std::equal(magic.begin(), version_at, kRecordingMagic.begin()))
        throw InputError(name_ + ": is no recording; accepted: a file of hilcam run --record");
    if (*version_at != kRecordingMagic.back())
        throw InputError(name_ + ": is a recording of format " + std::to_string(*version_at) +
                         "; accepted: format " + std::to_string(kRecordingMagic.back()));
    offset_ = magic.size();
    const std::optional<std::size_t> size = read_body(kMaxHeaderBytes);
    std::optional<RecordingHeader> header;
    if (size) header = decode_header(std::span(body_).first(*size));
    if (!header) throw InputError(name_ + ": the recording's header is damaged or cut off");
    header_ = std::move(*header);
    offset_ += kRecordPrefixBytes + *size;
    body_.resize(kMaxRecordBytes);
}

// Reads the next record into body_. Returns nothing when there is no whole one; end_ then says why.
std::optional<std::size_t> RecordingReader::read_body(std::size_t most) {
    std::array<std::uint8_t, kRecordPrefixBytes> prefix{};
    in_->read(reinterpret_cast<char*>(prefix.data()), static_cast<std::streamsize>(prefix.size()));
    end_ = RecordingEnd::kCutOff;
    if (static_cast<std::size_t>(in_->gcount()) < prefix.size()) return {};
    ByteReader fields(prefix);
    const std::uint32_t size = fields.u32(), crc = fields.u32();
    end_ = RecordingEnd::kDamaged;
    if (size == 0 || size > most) return {};
    // Allocates only as far as bytes exist, whatever the length says.
    constexpr std::size_t kPiece = 1u << 16;
    std::size_t have = 0;
    while (have < size) {
        const std::size_t piece = std::min<std::size_t>(kPiece, size - have);
        if (body_.size() < have + piece) body_.resize(have + piece);
        in_->read(reinterpret_cast<char*>(body_.data() + have), static_cast<std::streamsize>(piece));
        if (static_cast<std::size_t>(in_->gcount()) < piece) {
            end_ = RecordingEnd::kCutOff;
            return {};
        }
        have += piece;
    }
    if (crc32_of(std::span(body_).first(size)) != crc) return {};
    end_ = RecordingEnd::kNone;
    return size;
}

bool RecordingReader::next(Record& record) {
    if (end_ != RecordingEnd::kNone) return false;
    const std::optional<std::size_t> size = read_body(kMaxRecordBytes);
    if (!size) return false;
    const std::optional<Record> decoded = decode_record(std::span(body_).first(*size));
    if (!decoded) {
        end_ = RecordingEnd::kDamaged;
        return false;
    }
    record = *decoded;
    if (stop_at_loss_ && std::holds_alternative<RecordedLoss>(record)) {
        end_ = RecordingEnd::kLoss;
        return false;
    }
    offset_ += kRecordPrefixBytes + *size;
    if (std::holds_alternative<RecordedEnd>(record)) end_ = RecordingEnd::kClean;
    return end_ == RecordingEnd::kNone;
}

std::string RecordingReader::end_text() const {
    const std::string at = name_ + ": byte " + std::to_string(offset_) + ": ";
    switch (end_) {
        case RecordingEnd::kNone:
            return at + "there is more";
        case RecordingEnd::kClean:
            return at + "the run ended";
        case RecordingEnd::kCutOff:
            return at + "the recording is cut off";
        case RecordingEnd::kDamaged:
            return at + "the recording is damaged";
        case RecordingEnd::kLoss:
            break;
    }
    return at + "records were lost when it was made";
}

}  // namespace hilcam
