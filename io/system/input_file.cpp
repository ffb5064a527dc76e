#include "io/system/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <streambuf>
#include <vector>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

std::string kind_of(mode_t mode) {
    if (S_ISDIR(mode)) return "a folder";
    if (S_ISFIFO(mode)) return "a pipe, not a regular file";
    if (S_ISSOCK(mode)) return "a socket, not a regular file";
    return "a device, not a regular file";
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& found, const InputKind& kind) {
    throw InputError(file.string() + ": " + found + "; accepted: " + kind.accepted);
}

std::string size_text(std::uintmax_t bytes) {
    return bytes < 1u << 20 ? std::to_string(bytes) + " bytes" : std::to_string(bytes >> 20) + " MiB";
}

}  // namespace

InputFile open_input_file(const std::filesystem::path& file, const InputKind& kind) {
    struct stat found {};
    const auto require_regular = [&](int result) {
        if (result != 0 && errno == ENOENT) refuse(file, "no such file", kind);
        if (result != 0) refuse(file, std::string("cannot be read: ") + std::strerror(errno), kind);
        if (!S_ISREG(found.st_mode)) refuse(file, "cannot be read: it is " + kind_of(found.st_mode), kind);
    };
    // Checked before opening, because opening a device can have effects, and again after, because the file
    // may have been replaced in between. O_NONBLOCK: a pipe that has just replaced it does not block.
    require_regular(stat(file.c_str(), &found));
    InputFile out{Fd(open(file.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC)), 0};
    require_regular(out.fd ? fstat(out.fd.get(), &found) : -1);
    out.bytes = static_cast<std::uintmax_t>(found.st_size);
    if (out.bytes > kind.max_bytes)
        throw InputError(file.string() + ": has " + std::to_string(out.bytes) + " bytes; accepted: at most " +
                         size_text(kind.max_bytes));
    return out;
}

void read_input_piece(const InputFile& in, const std::filesystem::path& file, std::uintmax_t from, char* to,
                      std::size_t size) {
    while (size > 0) {
        const ssize_t got = pread(in.fd.get(), to, size, static_cast<off_t>(from));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) throw InputError(file.string() + ": cannot be read: " + std::strerror(errno));
        if (got == 0)
            throw InputError(file.string() + ": ends at byte " + std::to_string(from) + " of " +
                             std::to_string(in.bytes) + ": it became shorter while it was read");
        to += got, from += static_cast<std::uintmax_t>(got), size -= static_cast<std::size_t>(got);
    }
}

std::string read_input_file(const std::filesystem::path& file, const InputKind& kind) {
    const InputFile in = open_input_file(file, kind);
    std::string text(in.bytes, '\0');
    read_input_piece(in, file, 0, text.data(), text.size());
    return text;
}

class InputStream::Buffer final : public std::streambuf {
  public:
    Buffer(std::filesystem::path file, const InputKind& kind)
        : file_(std::move(file)), in_(open_input_file(file_, kind)) {}
    std::uintmax_t bytes() const { return in_.bytes; }

  private:
    std::filesystem::path file_;
    InputFile in_;
    std::uintmax_t read_ = 0;
    std::vector<char> piece_ = std::vector<char>(std::size_t{1} << 18);

    int_type underflow() override {
        const auto size =
            static_cast<std::size_t>(std::min<std::uintmax_t>(piece_.size(), in_.bytes - read_));
        if (size == 0) return traits_type::eof();
        read_input_piece(in_, file_, read_, piece_.data(), size);
        read_ += size;
        setg(piece_.data(), piece_.data(), piece_.data() + size);
        return traits_type::to_int_type(piece_.front());
    }
};

InputStream::InputStream(const std::filesystem::path& file, const InputKind& kind)
    : std::istream(nullptr), buffer_(std::make_unique<Buffer>(file, kind)) {
    rdbuf(buffer_.get());
    // Makes exceptions of the buffer pass through; an istream swallows them otherwise.
    exceptions(std::ios::badbit);
}

InputStream::~InputStream() = default;

std::uintmax_t InputStream::bytes() const { return buffer_->bytes(); }

}  // namespace hilcam
