#pragma once
// Commands over UDP: a thread receives datagrams, gives them to the station and sends the answers.

#include <string>
#include <thread>

#include "io/commands/command_station.h"
#include "io/commands/udp_peers.h"
#include "io/contract/command_receiver.h"
#include "io/system/allow_list.h"
#include "io/system/fd.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

struct UdpCommandConfig {
    std::string address = "127.0.0.1";
    std::int64_t port = 5010;
    std::vector<std::string> allow{};
    DialectConfig dialect{};
};
Fields fields(UdpCommandConfig& config);
void validate(const UdpCommandConfig& config);

// A datagram holds one or more packets back to back; each is acknowledged to the sender's address and port in
// a datagram of its own. Bytes that cannot be divided into packets are refused once. The arrival time is the
// kernel's receive time stamp, converted to CLOCK_MONOTONIC. The last sixteen senders are remembered for a
// minute each, and so are their subscriptions to telemetry.
class UdpCommandReceiver : public CommandReceiver {
  public:
    UdpCommandReceiver(const UdpCommandConfig& config, CommandHandler& handler);
    ~UdpCommandReceiver() override { stop(); }

    // Throws DeviceError when the port is taken.
    void start() override;
    void stop() noexcept override;
    std::string name() const override;
    CommandReport report() const override { return station_.report(); }
    std::vector<SenderReport> senders() const override { return station_.senders(); }
    void notify(const Telemetry& telemetry) noexcept override;

  private:
    void run();
    void receive();
    void send_telemetry();
    void send(std::span<const std::uint8_t> packet, const sockaddr_in& to);

    UdpCommandConfig config_;
    AllowList allow_;
    CommandStation station_;
    UdpPeers peers_{station_};
    PacketStream stream_;
    TelemetryQueue telemetry_;
    Fd socket_, wakeup_ = open_wakeup();
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace hilcam
