#include "io/system/tcp_peer.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include "io/system/fd.h"

namespace hilcam {

bool admit_tcp(const AllowList& allow, int socket, std::string& peer) {
    sockaddr_in from{};
    socklen_t size = sizeof from;
    if (getpeername(socket, reinterpret_cast<sockaddr*>(&from), &size) != 0) return false;
    peer = format_ipv4(ntohl(from.sin_addr.s_addr)) + ":" + std::to_string(ntohs(from.sin_port));
    const auto set = [&](int level, int name, int value) {
        setsockopt(socket, level, name, &value, sizeof value);
    };
    set(IPPROTO_TCP, TCP_NODELAY, 1);
    set(SOL_SOCKET, SO_KEEPALIVE, 1);
    set(IPPROTO_TCP, TCP_KEEPIDLE, 10);
    set(IPPROTO_TCP, TCP_KEEPINTVL, 5);
    set(IPPROTO_TCP, TCP_KEEPCNT, 4);
    return allow.allows(ntohl(from.sin_addr.s_addr));
}

}  // namespace hilcam
