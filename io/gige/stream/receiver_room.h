#pragma once
// Estimates how much a receiver on this machine can still take: the flow control that the loopback interface
// lacks.
//
// A wire limits a stream to what it carries and a network card's driver is served before programs are; on
// loopback a sender overruns a receiver's buffer (208 KiB by default) whenever that has to wait a millisecond
// for a core. The kernel tells the fill level of any UDP socket of this network namespace through
// NETLINK_SOCK_DIAG (linux/inet_diag.h), without rights. Where that is absent, and for receivers elsewhere,
// there is no answer.

#include <netinet/in.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "io/system/fd.h"

namespace hilcam {

class ReceiverRoom {
  public:
    ReceiverRoom();

    // Bytes (as the kernel counts them) still free in the buffer of the local socket that datagrams from
    // `from` to `to` go to. One thread; no allocation; some microseconds.
    std::optional<std::size_t> free_bytes(const sockaddr_in& from, const sockaddr_in& to) const noexcept;

    // Waits until that socket has room for so many bytes, or has been read nothing of for kPatience_ns, or
    // `stop`. A socket that nobody reads (a client that stands still, or that takes its packets from a packet
    // socket instead) is not waited for again before it has room.
    void wait(const sockaddr_in& from, const sockaddr_in& to, std::size_t bytes,
              const std::atomic<bool>& stop) noexcept;

    static constexpr std::int64_t kPatience_ns = 50'000'000;

    // Returns what a datagram takes of a receiver's buffer: its bytes and headers, rounded up to the kernel's
    // block sizes.
    static std::size_t bytes_of(std::size_t datagram_bytes);

  private:
    Fd netlink_;
    sockaddr_in unread_{};  // address of the receiver that was waited for in vain
};

}  // namespace hilcam
