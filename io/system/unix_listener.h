#pragma once
// A listening Unix socket of type SOCK_STREAM with a file of its own. It replaces a socket file without a
// listener, as a killed program leaves, and removes its file only while that is still its own.

#include <sys/types.h>

#include <string>

#include "io/system/fd.h"

namespace hilcam {

class UnixListener {
  public:
    UnixListener() = default;
    ~UnixListener() { close(); }
    UnixListener(const UnixListener&) = delete;
    UnixListener& operator=(const UnixListener&) = delete;

    // Non-blocking. Throws InputError when the path is too long, DeviceError when there is a listener or the
    // path is another kind of file. The file has mode 0660.
    void open(const std::string& path);
    void close() noexcept;
    const Fd& socket() const { return socket_; }

  private:
    Fd socket_;
    std::string path_;
    dev_t device_ = 0;
    ino_t inode_ = 0;
};

}  // namespace hilcam
