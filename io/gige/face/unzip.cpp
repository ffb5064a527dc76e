#include "io/gige/face/unzip.h"

#include <zlib.h>

#include <algorithm>

#include "io/system/crc32.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr std::uint32_t kLocalHeader = 0x04034b50, kDirectoryEntry = 0x02014b50, kDirectoryEnd = 0x06054b50;
constexpr std::size_t kLocalBytes = 30, kEntryBytes = 46, kDirectoryEndBytes = 22, kMaxRemark = 65535;
constexpr std::uint32_t kStored = 0, kDeflated = 8;

// Little-endian numbers; 0 past the end.
std::uint32_t number(std::span<const std::uint8_t> b, std::size_t at, std::size_t bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes && at + i < b.size(); ++i) value |= std::uint32_t{b[at + i]} << 8 * i;
    return value;
}

// The directory's end is behind everything but a remark.
std::size_t end_of_directory(std::span<const std::uint8_t> b) {
    if (b.size() < kDirectoryEndBytes) return 0;
    const std::size_t last = b.size() - kDirectoryEndBytes, first = last > kMaxRemark ? last - kMaxRemark : 0;
    for (std::size_t at = last + 1; at-- > first;)
        if (number(b, at, 4) == kDirectoryEnd) return at;
    return 0;
}

bool inflated(std::span<const std::uint8_t> from, std::string& out) {
    z_stream stream{};
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return false;
    // zlib does not write to its input.
    stream.next_in = const_cast<Bytef*>(from.data());
    stream.avail_in = static_cast<uInt>(from.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    const int result = inflate(&stream, Z_FINISH);
    const bool whole = result == Z_STREAM_END && stream.total_out == out.size();
    inflateEnd(&stream);
    return whole;
}

}  // namespace

bool is_zip(std::span<const std::uint8_t> bytes) {
    return bytes.size() >= 4 && number(bytes, 0, 4) == kLocalHeader;
}

std::string unzip_first(std::span<const std::uint8_t> b, std::size_t max_bytes, const std::string& name) {
    const auto refuse = [&](const std::string& what) {
        return InputError(name + ": is no zip that can be read: " + what);
    };
    const std::size_t end = end_of_directory(b);
    if (end == 0) throw refuse("it has no directory; it may be cut");
    const std::size_t entry = number(b, end + 16, 4);
    if (entry + kEntryBytes > end || number(b, entry, 4) != kDirectoryEntry)
        throw refuse("its directory is damaged");
    const std::uint32_t method = number(b, entry + 10, 2), sum = number(b, entry + 16, 4);
    const std::size_t packed = number(b, entry + 20, 4), size = number(b, entry + 24, 4);
    const std::size_t local = number(b, entry + 42, 4);
    if (number(b, entry + 8, 2) & 1u) throw refuse("it is encrypted");
    if (method != kStored && method != kDeflated)
        throw refuse("method " + std::to_string(method) + "; accepted: 0 (stored), 8 (deflated)");
    if (size > max_bytes)
        throw InputError(name + ": unzips to " + std::to_string(size) + " bytes; accepted: at most " +
                         std::to_string(max_bytes));
    if (local + kLocalBytes > b.size() || number(b, local, 4) != kLocalHeader)
        throw refuse("its first file is damaged");
    const std::size_t data = local + kLocalBytes + number(b, local + 26, 2) + number(b, local + 28, 2);
    if (data > b.size() || packed > b.size() - data) throw refuse("it is cut");
    std::string out(size, '\0');
    const auto from = b.subspan(data, packed);
    if (method == kStored ? packed != size : !inflated(from, out)) throw refuse("its data are damaged");
    if (method == kStored) std::copy(from.begin(), from.end(), out.begin());
    if (crc32_of({reinterpret_cast<const std::uint8_t*>(out.data()), out.size()}) != sum)
        throw refuse("its checksum is wrong");
    return out;
}

}  // namespace hilcam
