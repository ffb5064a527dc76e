#include "io/system/fd.h"

#include <arpa/inet.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <cerrno>
#include <charconv>
#include <cstring>

#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {

std::uint32_t parse_ipv4(const std::string& text, const std::string& key) {
    in_addr address{};
    if (inet_pton(AF_INET, text.c_str(), &address) != 1)
        throw refused(key, in_quotes(text), "an IPv4 address of this machine, as 127.0.0.1");
    return ntohl(address.s_addr);
}

std::string format_ipv4(std::uint32_t address) {
    const in_addr network{htonl(address)};
    char text[INET_ADDRSTRLEN] = {};
    inet_ntop(AF_INET, &network, text, sizeof text);
    return text;
}

sockaddr_in socket_address(std::uint32_t address, std::uint16_t port) {
    sockaddr_in out{};
    out.sin_family = AF_INET;
    out.sin_port = htons(port);
    out.sin_addr.s_addr = htonl(address);
    return out;
}

sockaddr_in parse_endpoint(const std::string& text) {
    const auto colon = text.rfind(':');
    unsigned port = 0;
    const char* begin = text.data() + (colon == std::string::npos ? text.size() : colon + 1);
    const auto [end, error] = std::from_chars(begin, text.data() + text.size(), port);
    if (colon == std::string::npos || error != std::errc{} || end != text.data() + text.size() || port == 0 ||
        port > 65535)
        throw InputError(in_quotes(text) + ": accepted: ADDRESS:PORT, as 127.0.0.1:5010");
    return socket_address(parse_ipv4(text.substr(0, colon), text), static_cast<std::uint16_t>(port));
}

namespace {

// Binds, or throws an error with the process that has the port and what to do. kind: "UDP", "TCP".
void bind_to(const Fd& fd, std::uint32_t address, std::uint16_t port, const std::string& kind) {
    const sockaddr_in where = socket_address(address, port);
    if (bind(fd.get(), reinterpret_cast<const sockaddr*>(&where), sizeof where) == 0) return;
    const int reason = errno;
    const std::string endpoint = kind + " " + format_ipv4(address) + ":" + std::to_string(port);
    if (reason == EADDRINUSE)
        throw DeviceError(endpoint + " is taken by another program; stop it (ss -" +
                          (kind == "UDP" ? "u" : "t") + "lpn shows it) or choose another address or port");
    if (reason == EADDRNOTAVAIL)
        throw DeviceError(endpoint + ": no interface of this machine has that address; 'ip addr' lists them");
    throw DeviceError(endpoint + " cannot be opened: " + std::strerror(reason));
}

void reuse_address(const Fd& fd) {
    const int on = 1;
    setsockopt(fd.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
}

}  // namespace

Fd open_udp(std::uint32_t address, std::uint16_t port, bool reuse) {
    Fd fd(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    if (!fd) throw DeviceError(std::string("no UDP socket: ") + std::strerror(errno));
    if (reuse) reuse_address(fd);
    bind_to(fd, address, port, "UDP");
    return fd;
}

Fd listen_tcp(std::uint32_t address, std::uint16_t port) {
    Fd fd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (!fd) throw DeviceError(std::string("no TCP socket: ") + std::strerror(errno));
    reuse_address(fd);  // connections of an earlier run may linger
    bind_to(fd, address, port, "TCP");
    if (listen(fd.get(), 16) != 0)
        throw DeviceError("TCP " + format_ipv4(address) + ":" + std::to_string(port) +
                          " cannot be listened at: " + std::strerror(errno));
    return fd;
}

sockaddr_un unix_address(const std::string& path) {
    sockaddr_un out{};
    out.sun_family = AF_UNIX;
    if (path.empty() || path.size() >= sizeof out.sun_path)
        throw InputError(in_quotes(path) + ": accepted: the path of a Unix socket, 1 to " +
                         std::to_string(sizeof out.sun_path - 1) + " bytes long");
    std::memcpy(out.sun_path, path.data(), path.size());
    return out;
}

Fd open_wakeup() {
    Fd fd(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
    if (!fd) throw DeviceError(std::string("no eventfd: ") + std::strerror(errno));
    return fd;
}

void wake(const Fd& wakeup) {
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto written = ::write(wakeup.get(), &one, sizeof one);
}

void drain(const Fd& wakeup) {
    std::uint64_t count = 0;
    [[maybe_unused]] const auto got = ::read(wakeup.get(), &count, sizeof count);
}

}  // namespace hilcam
