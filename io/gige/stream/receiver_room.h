#pragma once
// Estimates how much a receiver on this machine can still take: the flow control that the loopback interface
// lacks.
//
// A wire limits a stream to what it carries, and a network card's driver is served before programs are. On
// loopback, a sender overruns a receiver's buffer (208 KiB by default) whenever the receiver waits a
// millisecond for a core. The kernel reports the fill level of any UDP socket in this network namespace
// through NETLINK_SOCK_DIAG (linux/inet_diag.h), without privileges. Where that is missing, and for receivers
// elsewhere, there is no answer.

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

    // Returns the free bytes (as the kernel counts) in the buffer of the local socket that receives datagrams
    // from `from` to `to`. One thread; no allocation; takes some microseconds.
    std::optional<std::size_t> free_bytes(const sockaddr_in& from, const sockaddr_in& to) const noexcept;

    // Waits until that socket has room for this many bytes, was not read for kPatience_ns, or `stop` is set.
    // A socket that nobody reads (a client that hangs, or that reads a packet socket instead) is not waited
    // for again until it has room.
    void wait(const sockaddr_in& from, const sockaddr_in& to, std::size_t bytes,
              const std::atomic<bool>& stop) noexcept;

    static constexpr std::int64_t kPatience_ns = 50'000'000;

    // Returns what a datagram takes in a receiver's buffer: its bytes and headers, rounded up to the kernel's
    // block sizes.
    static std::size_t bytes_of(std::size_t datagram_bytes);

  private:
    Fd netlink_;
    sockaddr_in unread_{};  // address of the receiver that was waited for in vain
};

}  // namespace hilcam
