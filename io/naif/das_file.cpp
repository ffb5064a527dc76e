#include "io/naif/das_file.h"

#include <algorithm>
#include <cstdlib>

#include "io/naif/transfer_text.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

constexpr auto kDasRecord = static_cast<std::int64_t>(kNaifRecordBytes);
// Bytes of a character, a double, an integer.
constexpr std::array<std::int64_t, 3> kNumberBytes = {1, 8, 4};
// A directory is 256 integers: the previous and the next directory, the least and greatest address of each
// kind, the kind of the first cluster and its number of records, then those of the other clusters. These
// counts give the kind by their sign, in the cycle characters, doubles, integers: positive is the next kind,
// negative the previous one.
constexpr std::size_t kNextDirectory = 1, kAddressRanges = 2, kFirstKind = 8, kClusterCounts = 9,
                      kDirectoryIntegers = 256;

}  // namespace

DasFile::DasFile(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {
    if (transfer_kind_of(bytes_) == TransferKind::kDas) {
        read_transfer();
        return;
    }
    if (bytes_.size() < kNaifRecordBytes)
        fail("has " + std::to_string(bytes_.size()) +
             " bytes; accepted: a shape kernel, whose file record alone has 1024");
    const std::string_view record = bytes_.substr(0, kNaifRecordBytes);
    const std::string word = without_tail(record.substr(0, 8));
    if (word != "DAS/DSK") fail("found the identification " + in_quotes(word) + "; accepted: DAS/DSK");
    const std::string format = without_tail(record.substr(84, 8));
    if (format != "BIG-IEEE" && format != "LTL-IEEE")
        fail("found the binary format " + in_quotes(format) + "; accepted: LTL-IEEE, BIG-IEEE");
    numbers_.big_endian = format == "BIG-IEEE";
    if (!arrived_as_binary(record))
        fail(
            "was damaged when it was transferred as text (its FTP string is changed); accepted: one "
            "transferred "
            "as binary");
    const std::int64_t reserved = numbers_.integer_at(record.data() + 68);
    const std::int64_t comments = numbers_.integer_at(record.data() + 76);
    if (reserved < 0 || comments < 0)
        fail("has " + std::to_string(reserved) + " reserved records and " + std::to_string(comments) +
             " of comments; accepted: 0 or more");
    read_directories(2 + reserved + comments);
}

// Comments and characters are skipped; doubles and integers are in blocks, each after its count.
void DasFile::read_transfer() {
    is_transfer_ = true;
    TransferText text(bytes_, name_);
    if (const std::string word = text.quoted_line(); word != "DAS/DSK")
        text.fail("found the identification " + in_quotes(word) + "; accepted: DAS/DSK");
    text.quoted_line();
    for (int i = 0; i < 4; ++i) text.next_integer();  // reserved and comment records and characters
    if (text.comes("BEGIN_COMMENT_BLOCK")) text.pass("TOTAL_COMMENT_BLOCKS");
    const std::int32_t characters = text.next_integer(), doubles = text.next_integer(),
                       integers = text.next_integer();
    if (characters > 0) text.pass("TOTAL_CHARACTER_BLOCKS");
    const auto read_blocks = [&](const char* begin, const char* end, std::int32_t total, auto& out,
                                 const auto& next) {
        while (static_cast<std::int64_t>(out.size()) < total) {
            const std::int64_t count = text.require_marker(begin);
            if (count < 1 || count > total - static_cast<std::int64_t>(out.size()))
                text.fail("a block of " + std::to_string(count) +
                          " numbers; accepted: 1 to what is left of " + std::to_string(total));
            for (std::int64_t i = 0; i < count; ++i) out.push_back(next());
            text.require_marker(end);
        }
    };
    read_blocks("BEGIN_DP_BLOCK", "END_DP_BLOCK", doubles, decoded_doubles_,
                [&] { return text.next_double(); });
    if (doubles > 0) text.pass("TOTAL_DP_BLOCKS");
    read_blocks("BEGIN_INTEGER_BLOCK", "END_INTEGER_BLOCK", integers, decoded_integers_,
                [&] { return text.next_integer(); });
    kinds_[2].last = std::max(integers, 0);
}

template <class T>
std::vector<T> DasFile::decoded(const std::vector<T>& all, const char* what, std::int64_t first,
                                std::int64_t count) const {
    const auto size = static_cast<std::int64_t>(all.size());
    if (first < 1 || count < 0 || count > size - first + 1)
        fail(std::string("has ") + std::to_string(size) + " " + what + ", and " + std::to_string(count) +
             " from the " + std::to_string(first) + "th are asked for");
    return {all.begin() + (first - 1), all.begin() + (first - 1 + count)};
}

void DasFile::fail(const std::string& what) const { throw InputError(name_ + ": " + what); }

// Records are numbered from 1.
const char* DasFile::record_at(std::int64_t record, std::int64_t count) const {
    const auto records = static_cast<std::int64_t>(bytes_.size()) / kDasRecord;
    if (record < 2 || count < 0 || record - 1 > records - count)
        fail("is cut short or damaged: it has " + std::to_string(records) + " records, and " +
             std::to_string(count) + " from the " + std::to_string(record) + "th are asked for");
    return bytes_.data() + (record - 1) * kDasRecord;
}

void DasFile::read_directories(std::int64_t record) {
    for (std::int64_t seen = 0; record > 0; ++seen) {
        if (seen > static_cast<std::int64_t>(bytes_.size()) / kDasRecord)
            fail("its directories go in a circle; accepted: a chain that ends");
        const char* const directory = record_at(record, 1);
        add_clusters(directory, record);
        record = numbers_.integer_at(directory + 4 * kNextDirectory);
    }
}

void DasFile::add_clusters(const char* directory, std::int64_t record) {
    const auto at = [&](std::size_t i) -> std::int64_t { return numbers_.integer_at(directory + 4 * i); };
    std::array<std::int64_t, 3> next{};
    for (std::size_t k = 0; k < 3; ++k) {
        const std::int64_t first = at(kAddressRanges + 2 * k), last = at(kAddressRanges + 2 * k + 1);
        next[k] = kinds_[k].last + 1;
        if (last == 0) continue;
        if (first != next[k] || last < first)
            fail("its directory in record " + std::to_string(record) + " has addresses " +
                 std::to_string(first) + " to " + std::to_string(last) + "; accepted: from " +
                 std::to_string(next[k]) + " on");
        kinds_[k].last = last;
    }
    std::int64_t kind = at(kFirstKind);
    if (kind < 1 || kind > 3) {
        if (at(kClusterCounts) == 0) return;  // nothing is listed
        fail("its directory in record " + std::to_string(record) + " begins with the kind " +
             std::to_string(kind) + "; accepted: 1 to 3");
    }
    ++record;
    for (std::size_t i = kClusterCounts; i < kDirectoryIntegers && at(i) != 0; ++i) {
        const std::int64_t records = std::abs(at(i));
        if (i > kClusterCounts) kind = (kind - 1 + (at(i) > 0 ? 1 : 2)) % 3 + 1;
        const auto k = static_cast<std::size_t>(kind - 1);
        const char* const begin = record_at(record, records);
        const std::int64_t numbers = records * (kDasRecord / kNumberBytes[k]);
        kinds_[k].clusters.push_back({next[k], numbers, static_cast<std::uint64_t>(begin - bytes_.data())});
        next[k] += numbers, record += records;
    }
    for (std::size_t k = 0; k < 3; ++k)
        if (kinds_[k].last >= next[k])
            fail("has " + std::to_string(kinds_[k].last) + " addresses and records for " +
                 std::to_string(next[k] - 1) + "; accepted: a record for each");
}

template <class T, class Take>
std::vector<T> DasFile::numbers(const Kind& kind, const char* what, std::int64_t first, std::int64_t count,
                                const Take& take) const {
    if (first < 1 || count < 0 || count > kind.last - first + 1)
        fail(std::string("has ") + std::to_string(kind.last) + " " + what + ", and " + std::to_string(count) +
             " from the " + std::to_string(first) + "th are asked for");
    std::vector<T> out;
    out.reserve(static_cast<std::size_t>(count));
    for (const Cluster& cluster : kind.clusters) {
        const std::int64_t from = std::max(first, cluster.first);
        const std::int64_t end = std::min(first + count, cluster.first + cluster.numbers);
        const char* const bytes = bytes_.data() + cluster.byte;
        for (std::int64_t i = from; i < end; ++i)
            out.push_back(take(bytes + (i - cluster.first) * static_cast<std::int64_t>(sizeof(T))));
    }
    return out;
}

std::vector<std::int32_t> DasFile::integers(std::int64_t first, std::int64_t count) const {
    if (is_transfer_) return decoded(decoded_integers_, "integers", first, count);
    return numbers<std::int32_t>(kinds_[2], "integers", first, count,
                                 [this](const char* bytes) { return numbers_.integer_at(bytes); });
}

std::vector<double> DasFile::doubles(std::int64_t first, std::int64_t count) const {
    if (is_transfer_) return decoded(decoded_doubles_, "doubles", first, count);
    return numbers<double>(kinds_[1], "doubles", first, count,
                           [this](const char* bytes) { return numbers_.double_at(bytes); });
}

}  // namespace hilcam
