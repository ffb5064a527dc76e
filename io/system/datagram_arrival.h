#pragma once
// The instant at which the kernel received a datagram.

#include <sys/socket.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "io/system/monotonic.h"

namespace hilcam {

// Returns an instant of CLOCK_REALTIME on CLOCK_MONOTONIC, by its age. The age is limited to a second, so
// that a step of the wall clock between the two readings shifts the result by no more.
inline std::int64_t monotonic_of_realtime(std::int64_t realtime_ns) {
    const std::int64_t now_ns = monotonic_ns();
    return now_ns - std::clamp<std::int64_t>(clock_ns(CLOCK_REALTIME) - realtime_ns, 0, 1'000'000'000);
}

// Asks for time stamps of what a socket receives.
inline void ask_for_arrivals(int socket) {
    const int on = 1;
    setsockopt(socket, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
}

// Returns the arrival on CLOCK_MONOTONIC. The kernel stamps datagrams with CLOCK_REALTIME. Without a stamp,
// it is the present time.
inline std::int64_t arrival_of(msghdr& message) {
    for (cmsghdr* c = CMSG_FIRSTHDR(&message); c; c = CMSG_NXTHDR(&message, c)) {
        if (c->cmsg_level != SOL_SOCKET || c->cmsg_type != SCM_TIMESTAMPNS) continue;
        timespec stamp{};
        std::memcpy(&stamp, CMSG_DATA(c), sizeof stamp);
        return monotonic_of_realtime(std::int64_t{stamp.tv_sec} * 1'000'000'000 + stamp.tv_nsec);
    }
    return monotonic_ns();
}

}  // namespace hilcam
