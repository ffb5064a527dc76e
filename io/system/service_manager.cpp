#include "io/system/service_manager.h"

#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>

#include "io/system/fd.h"

namespace hilcam {

bool notify_service_manager(std::string_view state) noexcept {
    const char* const name = std::getenv("NOTIFY_SOCKET");
    if (!name) return false;
    const std::string_view path = name;
    sockaddr_un to{};
    to.sun_family = AF_UNIX;
    // A path, or "@" and the name of an abstract socket.
    if (path.size() < 2 || path.size() >= sizeof to.sun_path || (path[0] != '/' && path[0] != '@'))
        return false;
    std::copy(path.begin(), path.end(), to.sun_path);
    if (path[0] == '@') to.sun_path[0] = 0;
    const Fd socket(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    if (!socket) return false;
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path.size());
    return ::sendto(socket.get(), state.data(), state.size(), MSG_NOSIGNAL | MSG_DONTWAIT,
                    reinterpret_cast<const sockaddr*>(&to), size) == static_cast<ssize_t>(state.size());
}

}  // namespace hilcam
