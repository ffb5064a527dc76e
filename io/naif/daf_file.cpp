#include "io/naif/daf_file.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

constexpr std::size_t kRecordBytes = kNaifRecordBytes, kWordBytes = 8;
constexpr std::uint64_t kWordsInRecord = kRecordBytes / kWordBytes;
constexpr std::uintmax_t kMaxDafBytes = std::uintmax_t{1} << 34;
constexpr std::size_t kMaxArrays = 1'000'000;
constexpr std::uint64_t kMaxTransferBytes = std::uint64_t{1} << 30;

// Returns the kind in an identification word. Files from before 1996 have NAIF/DAF and are SPK or CK. Empty:
// none.
std::string kind_by(std::string_view word) {
    if (word == "NAIF/DAF") return "SPK";
    return word.starts_with("DAF/") ? std::string(word.substr(4)) : std::string();
}

std::int32_t integers_of(const std::string& kind) { return kind == "PCK" ? 5 : 6; }

}  // namespace

DafFile::DafFile(const std::filesystem::path& file)
    : name_(file.string()), file_(open_input_file(file, {kMaxDafBytes, "a SPICE kernel"})) {
    size_ = file_->bytes;
    open();
}

DafFile::DafFile(std::string bytes, std::string name)
    : name_(std::move(name)), bytes_(std::move(bytes)), size_(bytes_.size()) {
    open();
}

void DafFile::fail(const std::string& what) const { throw InputError(name_ + ": " + what); }

void DafFile::read(std::uint64_t from, char* to, std::size_t size) const {
    if (from > size_ || size > size_ - from)
        fail("is cut short: bytes " + std::to_string(from) + " to " + std::to_string(from + size) + " of " +
             std::to_string(size_) + " are asked for; accepted: a whole kernel");
    if (file_)
        read_input_piece(*file_, name_, from, to, size);
    else
        std::copy_n(bytes_.data() + from, size, to);
}

void DafFile::require_kind(std::int64_t doubles, std::int64_t integers) const {
    if (kind_ != "SPK" && kind_ != "CK" && kind_ != "PCK")
        fail("found the kind " + in_quotes(kind_) + " of kernel; accepted: SPK, CK, PCK");
    if (doubles != 2 || integers != integers_of(kind_))
        fail("its summaries have " + std::to_string(doubles) + " doubles and " + std::to_string(integers) +
             " integers; accepted: 2 and " + std::to_string(integers_of(kind_)));
}

// The arrays are in decoded_ one after the other, in the file's order.
void DafFile::read_transfer() {
    if (size_ > kMaxTransferBytes)
        fail("has " + std::to_string(size_) + " bytes of transfer format; accepted: at most 1 GiB");
    std::string bytes = std::move(bytes_);
    if (file_) {
        bytes.resize(size_);
        read(0, bytes.data(), bytes.size());
    }
    TransferText text(bytes, name_);
    const std::string word = text.quoted_line();
    kind_ = kind_by(word);
    if (kind_.empty())
        text.fail("found the identification " + in_quotes(word) + "; accepted: DAF/SPK, DAF/CK or DAF/PCK");
    const std::int32_t doubles = text.next_integer(), integers = text.next_integer();
    require_kind(doubles, integers);
    text.quoted_line();
    while (text.comes("BEGIN_ARRAY")) read_transfer_array(text, static_cast<std::size_t>(integers));
    // Without a second number: how many arrays there are.
    text.pass("TOTAL_ARRAYS");
}

void DafFile::read_transfer_array(TransferText& text, std::size_t integers) {
    if (arrays_.size() == kMaxArrays) text.fail("has more than 1000000 arrays");
    std::int64_t left = text.require_marker("BEGIN_ARRAY");
    if (left < 1) text.fail("an array of " + std::to_string(left) + " words; accepted: 1 or more");
    DafArray array;
    array.name = harmless(text.quoted_line());
    for (double& word : array.doubles) word = text.next_double();
    for (std::size_t i = 2; i < integers; ++i) array.integers.push_back(text.next_integer());
    array.first = decoded_.size() + 1;
    // Blocks, each after its count.
    while (left > 0) {
        const std::int64_t count = text.next_count();
        if (count < 1 || count > left)
            text.fail("a block of " + std::to_string(count) + " words; accepted: 1 to " +
                      std::to_string(left));
        for (std::int64_t i = 0; i < count; ++i) decoded_.push_back(text.next_double());
        left -= count;
    }
    array.last = decoded_.size();
    text.require_marker("END_ARRAY");
    arrays_.push_back(std::move(array));
}

void DafFile::open() {
    std::array<char, kRecordBytes> record{};
    read(0, record.data(), std::min<std::uint64_t>(size_, 8));
    if (transfer_kind_of({record.data(), 8}) == TransferKind::kDaf) return read_transfer();
    if (size_ < kRecordBytes)
        fail("has " + std::to_string(size_) +
             " bytes; accepted: a DAF kernel, whose file record alone has 1024");
    read(0, record.data(), record.size());
    const std::string_view text(record.data(), record.size());
    const std::string word = without_tail(text.substr(0, 8));
    kind_ = kind_by(word);
    if (kind_.empty())
        fail("found the identification " + in_quotes(word) + "; accepted: DAF/SPK, DAF/CK or DAF/PCK");
    const std::string format = without_tail(text.substr(88, 8));
    if (format == "BIG-IEEE")
        numbers_.big_endian = true;
    else if (format == "LTL-IEEE")
        numbers_.big_endian = false;
    else if (format.empty() || format.find_first_not_of('\0') == std::string::npos)
        // Older files do not say. The number of doubles in a summary reads as 2 in one byte order and as 2^25
        // in the other.
        numbers_.big_endian = NaifNumbers{true}.integer_at(record.data() + 8) == 2;
    else
        fail("found the binary format " + in_quotes(format) + "; accepted: LTL-IEEE, BIG-IEEE");
    if (!arrived_as_binary(text))
        fail(
            "was damaged when it was transferred as text (its FTP string is changed); accepted: one "
            "transferred as "
            "binary");
    const std::int32_t doubles = numbers_.integer_at(record.data() + 8),
                       integers = numbers_.integer_at(record.data() + 12);
    require_kind(doubles, integers);
    read_summaries(numbers_.integer_at(record.data() + 76), static_cast<std::size_t>(integers));
}

void DafFile::read_summaries(std::int32_t first_record, std::size_t integers) {
    const std::size_t summary_bytes = kWordBytes * (2 + (integers + 1) / 2);
    std::array<char, kRecordBytes> summaries{}, names{};
    std::uint64_t seen = 0, words = 0;
    for (std::int64_t record = first_record; record > 0;) {
        if (++seen > size_ / kRecordBytes)
            fail("its summary records go in a circle; accepted: a chain that ends");
        const auto from = static_cast<std::uint64_t>(record - 1) * kRecordBytes;
        read(from, summaries.data(), kRecordBytes);
        const double next = numbers_.double_at(summaries.data()),
                     count = numbers_.double_at(summaries.data() + 16);
        const auto most = static_cast<double>((kRecordBytes - 24) / summary_bytes);
        if (!(next >= 0 && next < 2147483648.0) || !(count >= 0 && count <= most))
            fail("its summary record " + std::to_string(record) + " is damaged");
        if (count > 0) read(from + kRecordBytes, names.data(), kRecordBytes);
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
            if (arrays_.size() == kMaxArrays) fail("has more than 1000000 arrays");
            arrays_.push_back(array_of(summaries.data() + 24 + i * summary_bytes,
                                       names.data() + i * summary_bytes, integers));
            words += arrays_.back().size();
            if (words > size_ / kWordBytes)
                fail("its first " + std::to_string(arrays_.size()) + " arrays have " + std::to_string(words) +
                     " words, and the file " + std::to_string(size_ / kWordBytes) +
                     ": they overlap; accepted: arrays of their own words");
        }
        record = static_cast<std::int64_t>(next);
    }
}

DafArray DafFile::array_of(const char* summary, const char* name, std::size_t integers) const {
    DafArray out;
    out.name = harmless(without_tail({name, kWordBytes * (2 + (integers + 1) / 2)}));
    for (std::size_t i = 0; i < 2; ++i) out.doubles[i] = numbers_.double_at(summary + kWordBytes * i);
    for (std::size_t i = 0; i < integers; ++i)
        out.integers.push_back(numbers_.integer_at(summary + 2 * kWordBytes + 4 * i));
    const std::int32_t last = out.integers.back(), first = out.integers[integers - 2];
    out.integers.resize(integers - 2);
    const std::string which =
        "array " + std::to_string(arrays_.size() + 1) + " (" + in_quotes(out.name) + ")";
    if (!std::isfinite(out.doubles[0]) || !std::isfinite(out.doubles[1]))
        fail(which + ": its span is no number");
    if (first < 1 || last < first)
        fail(which + ": found words " + std::to_string(first) + " to " + std::to_string(last) +
             "; accepted: addresses that rise");
    out.first = static_cast<std::uint64_t>(first), out.last = static_cast<std::uint64_t>(last);
    if (out.last > size_ / kWordBytes)
        fail(which + ": ends at word " + std::to_string(last) + ", and the file has " +
             std::to_string(size_ / kWordBytes) + ": it is cut short; accepted: a whole kernel");
    return out;
}

std::vector<double> DafFile::words(const DafArray& array) const {
    if (!decoded_.empty())
        return {decoded_.begin() + static_cast<std::ptrdiff_t>(array.first - 1),
                decoded_.begin() + static_cast<std::ptrdiff_t>(array.last)};
    std::vector<char> bytes(array.size() * kWordBytes);
    read((array.first - 1) * kWordBytes, bytes.data(), bytes.size());
    std::vector<double> out(array.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = numbers_.double_at(bytes.data() + i * kWordBytes);
        if (!std::isfinite(out[i]))
            fail("array " + in_quotes(array.name) + ": word " + std::to_string(i + 1) +
                 " is no number; accepted: finite ones");
    }
    return out;
}

}  // namespace hilcam
