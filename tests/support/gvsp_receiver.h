#pragma once
// A plain receiver of GigE Vision streams: sockets and packets, no Aravis. Addresses of 127.83.0.0/16 are the
// tests'.

#include <poll.h>
#include <sys/socket.h>

#include <vector>

#include "io/gige/stream/gige_stream.h"
#include "io/system/bytes.h"
#include "io/system/fd.h"

namespace hilcam {

inline constexpr int kPatience_ms = 5000;  // until a test gives up; nothing waits so long when all is well

inline sockaddr_in own_address(const Fd& socket) {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &size);
    return address;
}
inline Endpoint endpoint_of(const Fd& socket) {
    const sockaddr_in a = own_address(socket);
    return {ntohl(a.sin_addr.s_addr), ntohs(a.sin_port)};
}
// Empty: nothing came.
inline std::vector<std::uint8_t> receive(const Fd& socket, int patience_ms) {
    pollfd watched{socket.get(), POLLIN, 0};
    if (poll(&watched, 1, patience_ms) <= 0) return {};
    std::vector<std::uint8_t> bytes(65536);
    const ssize_t got = recv(socket.get(), bytes.data(), bytes.size(), 0);
    bytes.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    return bytes;
}

struct Packet {
    unsigned status = 0, flags = 0, format = 0;
    std::uint64_t block = 0;
    std::uint32_t id = 0;
    std::vector<std::uint8_t> data;
};
inline Packet parse(const std::vector<std::uint8_t>& bytes) {
    ByteReader in(bytes);
    Packet p;
    p.status = in.u16();
    p.block = in.u16();
    p.format = in.u8();
    p.id = std::uint32_t{in.u8()} << 16;
    p.id |= in.u16();
    if (p.format & 0x80) {
        p.flags = static_cast<unsigned>(p.block);
        p.format &= 0x7F;
        p.block = in.u64();
        p.id = in.u32();
    }
    p.data.assign(in.rest().begin(), in.rest().end());
    return p;
}

}  // namespace hilcam
