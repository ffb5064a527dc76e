#pragma once
// The control side's sockets of a GigE Vision camera on one address: commands, broadcasts, messages.
//
// A camera listens to its own interface only. But Linux delivers broadcasts to every socket bound to their
// address, whichever interface they arrive on, and accepts datagrams for any of its addresses from any
// network: a host on a LAN could control a loopback camera. So each datagram is checked for the interface on
// which it arrived (IP_PKTINFO, ip(7)), which needs no privileges.

#include <poll.h>

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "io/gige/stream/gige_stream.h"
#include "io/system/fd.h"
#include "io/system/net_interface.h"

namespace hilcam {

class GigeSockets {
  public:
    // Throws DeviceError when this machine lacks the address, or when port 3956 there is taken. Listens to
    // broadcasts where that is possible; several cameras share them.
    explicit GigeSockets(const NetInterface& net);

    std::uint16_t message_port() const { return message_port_; }
    // Waits for datagrams, for `wakeup`, or until the time-out.
    void wait(const Fd& wakeup, std::int64_t timeout_ns);
    // Calls receive(datagram, sender, whether it was broadcast) for datagrams that have arrived, at most
    // kAtOnce per socket. Returns how many others were discarded because they arrived on another interface.
    using Receive = std::function<void(std::span<const std::uint8_t>, Endpoint, bool)>;
    static constexpr int kAtOnce = 16;
    std::uint64_t take(const Receive& receive);

    void send_answer(std::span<const std::uint8_t> bytes, Endpoint to) noexcept;
    void send_message(std::span<const std::uint8_t> bytes, Endpoint to) noexcept;

  private:
    static void send(const Fd& socket, std::span<const std::uint8_t> bytes, Endpoint to) noexcept;
    // True when a datagram from the interface with this number is meant for the camera.
    bool is_heard(unsigned interface, bool broadcast);

    std::string interface_;
    unsigned interface_number_;  // its last number; a card that is plugged in again gets another
    Fd control_, message_;
    std::array<Fd, 2> broadcast_;  // to everybody, to the subnet
    std::uint16_t message_port_ = 0;
    std::array<pollfd, 5> watched_{};  // wakeup, control, broadcasts, message
};

}  // namespace hilcam
