#pragma once
// A PTP port's sockets on one interface, with the kernel's time stamps: UDP over IPv4 (IEEE 1588-2008, annex
// D: event messages to port 319, general ones to 320, group 224.0.1.129), or Ethernet (annex F: type 0x88F7,
// group 01-1B-19-00-00-00).
//
// Stamps are software stamps (Documentation/networking/timestamping.rst): the kernel takes them in its driver
// or on top of it, by CLOCK_REALTIME. They become CLOCK_MONOTONIC with both clocks read at the same time. The
// stamps of network cards are not used: their clocks have no relation to CLOCK_MONOTONIC that the kernel
// keeps. One thread.

#include <poll.h>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "io/system/fd.h"
#include "io/system/net_interface.h"

namespace hilcam {

enum class PtpTransport { kUdp, kEthernet };

class PtpSockets {
  public:
    // Throws DeviceError, with what to do about it: no right to open them, or no such interface any more.
    // Several programs may listen on one interface.
    PtpSockets(const NetInterface& net, PtpTransport transport);

    // Waits for messages, for `wakeup`, or until the time-out.
    void wait(const Fd& wakeup, std::int64_t timeout_ns);
    struct Listener {
        // A message; without an arrival when the kernel gave none.
        std::function<void(std::span<const std::uint8_t>, std::optional<std::int64_t> arrival_ns)> received;
        // The departure of the latest message that send() sent.
        std::function<void(std::int64_t departure_ns)> sent;
    };
    // Hands over what has come, at most kAtOnce messages a socket.
    static constexpr int kAtOnce = 64;
    void take(const Listener& listener);
    // Sends an event message to the group. False: the kernel did not take it.
    bool send(std::span<const std::uint8_t> message) noexcept;

  private:
    void open_udp_sockets(const NetInterface& net);
    void open_packet_socket(const NetInterface& net);
    void take_departures(const Listener& listener);

    PtpTransport transport_;
    int interface_number_;
    Fd event_, general_;       // Ethernet: both are event_
    std::uint32_t sends_ = 0;  // the kernel counts them, too (SOF_TIMESTAMPING_OPT_ID)
    std::array<pollfd, 3> watched_{};
};

}  // namespace hilcam
