#include "io/system/unix_socket_file.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <cerrno>
#include <cstring>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

bool binds(const Fd& fd, const sockaddr_un& where) {
    return bind(fd.get(), reinterpret_cast<const sockaddr*>(&where), sizeof where) == 0;
}

// True for a socket file that nobody listens on.
bool is_abandoned(const std::string& path, const sockaddr_un& where, int type) {
    struct stat file {};
    if (lstat(path.c_str(), &file) != 0 || !S_ISSOCK(file.st_mode)) return false;
    const Fd probe(::socket(AF_UNIX, type | SOCK_CLOEXEC, 0));
    return connect(probe.get(), reinterpret_cast<const sockaddr*>(&where), sizeof where) != 0 &&
           errno == ECONNREFUSED;
}

}  // namespace

Fd UnixSocketFile::listen(const std::string& path, int type) {
    const sockaddr_un where = unix_address(path);
    Fd fd(::socket(AF_UNIX, type | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (!fd) throw DeviceError(std::string("no Unix socket: ") + std::strerror(errno));
    bool bound = binds(fd, where);
    if (!bound && errno == EADDRINUSE && is_abandoned(path, where, type)) {
        unlink(path.c_str());
        bound = binds(fd, where);
    }
    if (!bound && errno == EADDRINUSE)
        throw DeviceError("Unix socket " + path +
                          " is taken by another program, or is some other file; stop it (ss -xlp shows it) "
                          "or choose another path");
    if (!bound) throw DeviceError("Unix socket " + path + " cannot be made: " + std::strerror(errno));
    chmod(path.c_str(), 0660);
    if (::listen(fd.get(), 16) != 0)
        throw DeviceError("Unix socket " + path + " cannot be listened at: " + std::strerror(errno));
    struct stat file {};
    lstat(path.c_str(), &file);
    path_ = path, device_ = file.st_dev, inode_ = file.st_ino;
    return fd;
}

void UnixSocketFile::remove() noexcept {
    if (inode_ == 0) return;
    struct stat file {};
    if (lstat(path_.c_str(), &file) == 0 && file.st_dev == device_ && file.st_ino == inode_)
        unlink(path_.c_str());
    inode_ = 0;
}

}  // namespace hilcam
