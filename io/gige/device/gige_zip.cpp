#include "io/gige/device/gige_zip.h"

#include <zlib.h>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr std::uint16_t kVersion20 = 20, kDeflate = 8;
constexpr std::uint16_t kJanuary1st1980 = 1 << 5 | 1;  // no date in binaries

// ZIP is little-endian.
class Bytes {
  public:
    std::vector<std::uint8_t> out;
    Bytes& u16(std::size_t v) { return number(v, 2); }
    Bytes& u32(std::size_t v) { return number(v, 4); }
    template <class T>
    Bytes& copy(const T& from) {
        out.insert(out.end(), from.begin(), from.end());
        return *this;
    }

  private:
    Bytes& number(std::size_t v, int bytes) {
        for (int i = 0; i < bytes; ++i) out.push_back(static_cast<std::uint8_t>(v >> 8 * i));
        return *this;
    }
};

// Compresses without zlib's header and checksum.
std::vector<std::uint8_t> deflated(const std::string& content) {
    z_stream stream{};
    HILCAM_CHECK(deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) ==
                 Z_OK);
    std::vector<std::uint8_t> out(deflateBound(&stream, static_cast<uLong>(content.size())));
    // zlib does not write to its input.
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
    stream.avail_in = static_cast<uInt>(content.size());
    stream.next_out = out.data();
    stream.avail_out = static_cast<uInt>(out.size());
    HILCAM_CHECK(deflate(&stream, Z_FINISH) == Z_STREAM_END);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

}  // namespace

std::vector<std::uint8_t> zip_of(const std::string& name, const std::string& content) {
    const std::vector<std::uint8_t> data = deflated(content);
    const std::size_t sum =
        crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size()));
    // The common part of the local header and the directory.
    const auto description = [&](Bytes& b) {
        b.u16(kVersion20).u16(0).u16(kDeflate).u16(0).u16(kJanuary1st1980);
        b.u32(sum).u32(data.size()).u32(content.size()).u16(name.size()).u16(0);
    };
    Bytes b;
    b.u32(0x04034b50);
    description(b);
    b.copy(name).copy(data);
    const std::size_t directory = b.out.size();
    b.u32(0x02014b50).u16(kVersion20);
    description(b);
    b.u16(0).u16(0).u16(0).u32(0).u32(0).copy(name);
    const std::size_t directory_bytes = b.out.size() - directory;
    constexpr std::size_t kEndBytes = 22;
    const std::size_t fill = (4 - (b.out.size() + kEndBytes) % 4) % 4;
    b.u32(0x06054b50).u16(0).u16(0).u16(1).u16(1).u32(directory_bytes).u32(directory).u16(fill);
    b.copy(std::string(fill, ' '));
    return std::move(b.out);
}

}  // namespace hilcam
