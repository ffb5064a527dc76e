#pragma once
// Opens and reads the files that users name, by whatever key or option.
//
// Only regular files and symlinks to them are opened: a pipe may never deliver, and a device may never end.
// Opening does not block, and each kind of file has a largest size. A file counts as it was when it was
// opened: bytes added later are ignored, and a file that becomes shorter is refused.

#include <cstdint>
#include <filesystem>
#include <istream>
#include <memory>
#include <string>

#include "io/system/fd.h"

namespace hilcam {

struct InputKind {
    std::uintmax_t max_bytes;
    std::string accepted;  // end of the message "...; accepted: "
};

struct InputFile {
    Fd fd;
    std::uintmax_t bytes;  // size when it was opened
};

// Throws InputError, one line that names the file, when it is missing, not a regular file, not readable or
// too large.
InputFile open_input_file(const std::filesystem::path& file, const InputKind& kind);
// Returns the whole file. Throws InputError as above, and when the file became shorter meanwhile.
std::string read_input_file(const std::filesystem::path& file, const InputKind& kind);

// Reads the bytes [from, from + size) of an open file, all of them. file: its name in messages. Throws
// InputError when the file became shorter meanwhile.
void read_input_piece(const InputFile& in, const std::filesystem::path& file, std::uintmax_t from, char* to,
                      std::size_t size);

// Reads a file piece by piece, for files that need not be in memory whole. A read throws InputError when the
// file became shorter meanwhile.
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
