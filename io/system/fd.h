#pragma once
// A file descriptor that closes itself, and sockets.

#include <netinet/in.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdint>
#include <string>
#include <utility>

namespace hilcam {

class Fd {
  public:
    Fd() = default;
    explicit Fd(int fd) : fd_(fd) {}
    ~Fd() { reset(); }
    Fd(Fd&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    Fd& operator=(Fd&& other) noexcept {
        reset();
        fd_ = std::exchange(other.fd_, -1);
        return *this;
    }
    int get() const { return fd_; }
    explicit operator bool() const { return fd_ >= 0; }
    void reset() {
        if (fd_ >= 0) ::close(fd_);
        fd_ = -1;
    }

  private:
    int fd_ = -1;
};

// Returns the address in host order. Throws InputError unless the text is a dotted quad.
std::uint32_t parse_ipv4(const std::string& text, const std::string& key);
std::string format_ipv4(std::uint32_t address);
sockaddr_in socket_address(std::uint32_t address, std::uint16_t port);
// Parses "HOST:PORT" with a numeric host. Throws InputError.
sockaddr_in parse_endpoint(const std::string& text);

// Returns a UDP socket bound to an address. A DeviceError says which process has the port and what to do.
// reuse: several sockets may share a broadcast address.
Fd open_udp(std::uint32_t address, std::uint16_t port, bool reuse = false);
// Returns a non-blocking listening TCP socket, with the same errors.
Fd listen_tcp(std::uint32_t address, std::uint16_t port);
// Throws InputError when the path is too long.
sockaddr_un unix_address(const std::string& path);
// Returns an eventfd that wakes a poll().
Fd open_wakeup();
void wake(const Fd& wakeup);
// Empties the wakeup, so that the next poll() waits.
void drain(const Fd& wakeup);

}  // namespace hilcam
