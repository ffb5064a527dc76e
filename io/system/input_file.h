#pragma once
// Files that somebody gives, by whatever key or option: how each of them is opened and read.
//
// Only regular files are opened (a symlink to one is as good): a pipe may never speak and a device may never
// end. Nothing waits, each kind of file has a largest size, and a file holds what it held when it was opened:
// bytes that are added while it is read are left out, and one that loses bytes meanwhile is refused.

#include <cstdint>
#include <filesystem>
#include <istream>
#include <memory>
#include <string>

#include "io/system/fd.h"

namespace hilcam {

struct InputKind {
    std::uintmax_t max_bytes;
    std::string accepted;  // ends the message "...; accepted: "
};

struct InputFile {
    Fd fd;
    std::uintmax_t bytes;  // its size when it was opened
};

// Throws InputError, one line that names the file, when it is missing, no regular file, not readable or too
// large.
InputFile open_input_file(const std::filesystem::path& file, const InputKind& kind);
// The whole file. InputError as above, and when it became shorter meanwhile.
std::string read_input_file(const std::filesystem::path& file, const InputKind& kind);

// Reads bytes [from, from + size) of a file that was opened, all of them; `file` names it in messages. Throws InputError
// when the file became shorter meanwhile.
void read_input_piece(const InputFile& in, const std::filesystem::path& file, std::uintmax_t from, char* to,
                      std::size_t size);

// The same piece by piece, for files that are not worth holding in memory whole. A read throws InputError
// when the file became shorter meanwhile.
class InputStream final : public std::istream {
  public:
    InputStream(const std::filesystem::path& file, const InputKind& kind);
    ~InputStream() override;
    InputStream(const InputStream&) = delete;
    InputStream& operator=(const InputStream&) = delete;

    std::uintmax_t bytes() const;

  private:
    class Buffer;
    std::unique_ptr<Buffer> buffer_;
};

}  // namespace hilcam
