#include "io/cache/cache_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "io/system/crc32.h"
#include "io/system/fd.h"
#include "render/vocabulary/fnv.h"

namespace hilcam {
namespace {

// The end of a file. The struct has no padding.
struct FileEnd {
    std::array<char, 8> magic = {'h', 'i', 'l', 'c', 'a', 'm', 'C', 'K'};
    std::uint64_t bytes = 0;  // bytes before it
    std::uint32_t crc = 0, unused = 0;
    bool operator==(const FileEnd&) const = default;
};
static_assert(sizeof(FileEnd) == 24);

std::uint32_t crc_of(const void* data, std::size_t size, std::uint32_t before) {
    return crc32_of({static_cast<const std::uint8_t*>(data), size}, before);
}

}  // namespace

void CacheWriter::write_out(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    while (size > 0 && error_ == 0) {
        const ssize_t wrote = ::write(fd_, bytes, size);
        if (wrote < 0 && errno == EINTR) continue;
        if (wrote <= 0) {
            error_ = wrote < 0 ? errno : EIO;
            return;
        }
        bytes += wrote, size -= static_cast<std::size_t>(wrote);
    }
}

void CacheWriter::flush() {
    write_out(waiting_.data(), waiting_.size());
    waiting_.clear();
}

void CacheWriter::put(const void* data, std::size_t size) {
    constexpr std::size_t kPiece = 1 << 16;
    crc_ = crc_of(data, size, crc_);
    bytes_ += size;
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    if (size < kPiece) {
        waiting_.insert(waiting_.end(), bytes, bytes + size);
        if (waiting_.size() >= kPiece) flush();
        return;
    }
    flush();
    write_out(data, size);
}

bool CacheWriter::finish() {
    FileEnd end;
    end.bytes = bytes_, end.crc = crc_;
    flush();
    write_out(&end, sizeof end);
    if (error_ == 0 && fsync(fd_) != 0) error_ = errno;
    return error_ == 0;
}

CacheReader::CacheReader(const std::filesystem::path& file) {
    Fd fd(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    struct stat about {};
    if (!fd || fstat(fd.get(), &about) != 0 || !S_ISREG(about.st_mode)) return;
    file_.reset(fdopen(dup(fd.get()), "rb"));
    const auto size = static_cast<std::uint64_t>(about.st_size);
    good_ = file_ != nullptr && size >= sizeof(FileEnd);
    if (good_) left_ = size - sizeof(FileEnd);
}

void CacheReader::take(void* data, std::size_t size) {
    if (size > left_) good_ = false;
    if (!good_ || size == 0) return;
    if (std::fread(data, 1, size, file_.get()) != size) {
        good_ = false;
        return;
    }
    left_ -= size, bytes_ += size;
    crc_ = crc_of(data, size, crc_);
}

bool CacheReader::holds() {
    if (!good_ || left_ != 0) return false;
    FileEnd expected;
    expected.bytes = bytes_, expected.crc = crc_;
    FileEnd end;
    left_ = sizeof end;
    take(&end, sizeof end);
    return good_ && end == expected;
}

void CacheReader::mark_used() {
    if (file_) futimens(fileno(file_.get()), nullptr);
}

std::uint64_t hash_of(std::uint64_t hash, const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    Fnv1a out(hash);
    for (std::size_t i = 0; i < size; i += 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes + i, std::min<std::size_t>(8, size - i));
        out.take(word);
    }
    out.take(size);
    return out.value();
}

std::uint64_t hash_of(const Mesh& mesh) {
    std::uint64_t hash = Fnv1a().value();
    const auto add = [&](const auto& values) {
        hash = hash_of(hash, values.data(), values.size() * sizeof(values[0]));
    };
    add(mesh.vertices_m);
    add(mesh.normals);
    add(mesh.uvs);
    add(mesh.triangles);
    add(mesh.surface_of_triangle);
    if (!mesh.colors.empty()) add(mesh.colors);
    return hash;
}

}  // namespace hilcam
