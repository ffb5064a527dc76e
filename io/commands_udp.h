#pragma once
// Commands over UDP: a thread of its own receives datagrams, decodes, hands over and acknowledges.

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>

#include "io/command.h"
#include "io/fd.h"
#include "render/config_field.h"

namespace hilcam {

struct UdpCommandConfig {
    std::string address = "127.0.0.1";
    std::int64_t port = 5010;
};
Fields fields(UdpCommandConfig& config);

// A datagram holds one or more packets back to back; each is acknowledged to the sender's address. What
// cannot be cut into packets is refused once. Arrival is the kernel's receive time stamp, on CLOCK_MONOTONIC.
// Not checked: who the sender is. Bind to loopback, or to a network of the bench alone.
class UdpCommandReceiver {
  public:
    UdpCommandReceiver(const UdpCommandConfig& config, CommandHandler& handler);
    ~UdpCommandReceiver() { stop(); }

    // Throws DeviceError when the port is taken. Owner thread.
    void start();
    void stop() noexcept;
    // Any thread.
    CommandReport report() const;

  private:
    void run();
    void take_datagram(std::span<const std::uint8_t> datagram, std::int64_t arrival_ns,
                       const sockaddr_in& sender);
    void take_packet(std::span<const std::uint8_t> packet, std::int64_t arrival_ns,
                     const sockaddr_in& sender);
    void count_lost(std::uint32_t sequence, const sockaddr_in& sender);

    UdpCommandConfig config_;
    CommandHandler& handler_;
    Fd socket_, wakeup_;
    std::thread thread_;
    std::uint16_t acknowledgements_ = 0;
    struct Sender {
        std::uint64_t endpoint = 0;
        std::uint32_t next = 0;
    };
    std::array<Sender, 16> senders_{};
    std::size_t next_sender_ = 0;
    std::atomic<std::uint64_t> received_{0}, refused_{0}, lost_{0};
};

}  // namespace hilcam
