#pragma once
// The control side's sockets of a GigE Vision camera on one address: commands, broadcasts, messages.

#include <poll.h>

#include <array>
#include <cstdint>
#include <functional>
#include <span>

#include "io/fd.h"
#include "io/gige_stream.h"
#include "io/net_interface.h"

namespace hilcam {

class GigeSockets {
  public:
    // Throws DeviceError when the address is not this machine's or port 3956 there is taken. Broadcasts are
    // listened to where that is possible: several cameras share them.
    explicit GigeSockets(const NetInterface& net);

    std::uint16_t message_port() const { return message_port_; }
    // Waits for datagrams, for `wakeup` or for so long.
    void wait(const Fd& wakeup, std::int64_t timeout_ns);
    // What wait() saw: (datagram, sender, whether it was broadcast). At most kAtOnce of each socket.
    using Receive = std::function<void(std::span<const std::uint8_t>, Endpoint, bool)>;
    static constexpr int kAtOnce = 16;
    void take(const Receive& receive);

    void send_answer(std::span<const std::uint8_t> bytes, Endpoint to) noexcept;
    void send_message(std::span<const std::uint8_t> bytes, Endpoint to) noexcept;

  private:
    static void send(const Fd& socket, std::span<const std::uint8_t> bytes, Endpoint to) noexcept;

    Fd control_, message_;
    std::array<Fd, 2> broadcast_;  // to everybody, to the subnet
    std::uint16_t message_port_ = 0;
    std::array<pollfd, 4> watched_{};
};

}  // namespace hilcam
