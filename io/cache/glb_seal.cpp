#include "io/cache/glb_seal.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <vector>

#include "io/system/crc32.h"
#include "io/system/fd.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr std::size_t kGlbHeaderBytes = 12, kLengthAt = 8;  // magic, version, length
// A chunk's length, its type "HCRC", and the checksum.
using Seal = std::array<std::uint8_t, 12>;
constexpr Seal kEmptySeal = {4, 0, 0, 0, 'H', 'C', 'R', 'C'};
constexpr std::size_t kSealChecksumAt = 8;

void put_little(std::uint64_t value, std::uint8_t* to) {
    for (std::size_t i = 0; i < 4; ++i) to[i] = static_cast<std::uint8_t>(value >> (8 * i));
}

bool read_at(int fd, std::uint64_t from, std::span<std::uint8_t> to) {
    while (!to.empty()) {
        const ssize_t size = pread(fd, to.data(), to.size(), static_cast<off_t>(from));
        if (size < 0 && errno == EINTR) continue;
        if (size <= 0) return false;
        to = to.subspan(static_cast<std::size_t>(size)), from += static_cast<std::uint64_t>(size);
    }
    return true;
}

bool write_at(int fd, std::uint64_t to, std::span<const std::uint8_t> from) {
    while (!from.empty()) {
        const ssize_t size = pwrite(fd, from.data(), from.size(), static_cast<off_t>(to));
        if (size < 0 && errno == EINTR) continue;
        if (size <= 0) return false;
        from = from.subspan(static_cast<std::size_t>(size)), to += static_cast<std::uint64_t>(size);
    }
    return true;
}

// Returns the checksum of the first bytes; none when they cannot be read.
std::optional<std::uint32_t> checksum(int fd, std::uint64_t bytes) {
    std::vector<std::uint8_t> piece(1 << 20);
    std::uint32_t crc = 0;
    for (std::uint64_t at = 0; at < bytes; at += piece.size()) {
        const std::span<std::uint8_t> part(piece.data(), std::min<std::uint64_t>(piece.size(), bytes - at));
        if (!read_at(fd, at, part)) return std::nullopt;
        crc = crc32_of(part, crc);
    }
    return crc;
}

std::optional<std::uint64_t> size_of(int fd) {
    struct stat about {};
    if (fstat(fd, &about) != 0 || !S_ISREG(about.st_mode)) return std::nullopt;
    return static_cast<std::uint64_t>(about.st_size);
}

// Returns the seal for the end of these bytes; nothing when they cannot be read.
std::optional<Seal> seal_of(int fd, std::uint64_t bytes) {
    Seal seal = kEmptySeal;
    std::optional<std::uint32_t> crc = checksum(fd, bytes);
    if (!crc) return std::nullopt;
    crc = crc32_of(std::span(seal).first(kSealChecksumAt), *crc);
    put_little(*crc, seal.data() + kSealChecksumAt);
    return seal;
}

}  // namespace

void seal_glb(const std::filesystem::path& file) {
    const Fd fd(open(file.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW));
    const std::optional<std::uint64_t> size = fd ? size_of(fd.get()) : std::nullopt;
    std::array<std::uint8_t, kGlbHeaderBytes> header{};
    if (!size || !read_at(fd.get(), 0, header) || std::memcmp(header.data(), "glTF", 4) != 0 ||
        *size + kEmptySeal.size() > std::numeric_limits<std::uint32_t>::max())
        throw DeviceError(file.string() + ": no binary glTF was made");
    put_little(*size + kEmptySeal.size(), header.data() + kLengthAt);
    bool good = write_at(fd.get(), 0, header);
    const std::optional<Seal> seal = good ? seal_of(fd.get(), *size) : std::nullopt;
    good = seal && write_at(fd.get(), *size, *seal) && fsync(fd.get()) == 0;
    if (!good) throw DeviceError(file.string() + " cannot be written: " + std::strerror(errno));
}

bool is_sealed_glb(int fd) {
    const std::optional<std::uint64_t> size = size_of(fd);
    if (!size || *size < kGlbHeaderBytes + kEmptySeal.size()) return false;
    const std::uint64_t before = *size - kEmptySeal.size();
    Seal found{};
    return read_at(fd, before, found) && seal_of(fd, before) == found;
}

}  // namespace hilcam
