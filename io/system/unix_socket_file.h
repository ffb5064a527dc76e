#pragma once
// The file of a listening Unix socket. It replaces one without a listener, as a killed program leaves, and is
// removed only while it is still its own.

#include <sys/types.h>

#include <string>

#include "io/system/fd.h"

namespace hilcam {

class UnixSocketFile {
  public:
    UnixSocketFile() = default;
    ~UnixSocketFile() { remove(); }
    UnixSocketFile(const UnixSocketFile&) = delete;
    UnixSocketFile& operator=(const UnixSocketFile&) = delete;

    // Makes the file, of mode 0660, and returns its socket, which listens and is non-blocking. type:
    // SOCK_STREAM, SOCK_SEQPACKET. Throws InputError when the path is too long, DeviceError when there is a
    // listener or the path is another kind of file.
    Fd listen(const std::string& path, int type);
    // Call it when the socket is closed.
    void remove() noexcept;

  private:
    std::string path_;
    dev_t device_ = 0;
    ino_t inode_ = 0;  // 0: there is no file
};

}  // namespace hilcam
