#pragma once
// Serves the clients of a listening stream socket, TCP or Unix: packets in, answers and telemetry out. One
// thread serves them all without waiting for any. What a client does not read is queued up to 256 KiB; then
// its telemetry is dropped, and the client is disconnected when its answers do not fit either.

#include <atomic>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "io/commands/command_station.h"
#include "io/contract/command_receiver.h"
#include "io/system/fd.h"
#include "io/system/output_queue.h"

namespace hilcam {

struct StreamServerSetup {
    std::string name;  // name of the receiver
    // Returns a non-blocking listening socket. Throws InputError and DeviceError.
    std::function<Fd()> listen;
    // True when a connected client may stay; sets its name and prepares the socket.
    std::function<bool(int socket, std::string& peer)> admit;
    std::function<void()> closed = [] {};  // called after the listening socket is closed
    std::size_t max_clients = 8;
    bool whole_packets = false;  // SOCK_SEQPACKET: a message is one or more whole packets
    bool read_only = false;      // clients get all telemetry; what they send is discarded
};

class StreamServer : public CommandReceiver {
  public:
    StreamServer(StreamServerSetup setup, CommandHandler& handler, const DialectConfig& dialect);
    ~StreamServer() override { StreamServer::stop(); }

    void start() override;
    void stop() noexcept override;
    std::string name() const override { return setup_.name; }
    CommandReport report() const override { return station_.report(); }
    std::vector<SenderReport> senders() const override { return station_.senders(); }
    void notify(const Telemetry& telemetry) noexcept override;

  private:
    struct Client {
        Fd socket;
        CommandStation::Sender& sender;
        PacketStream stream;
        OutputQueue output;
        bool gone = false, cut_off = false;
    };
    void run();
    void accept_client();
    void receive(Client& client);
    void answer(Client& client, std::span<const std::uint8_t> packet);
    void send_telemetry();
    void drop_gone();

    StreamServerSetup setup_;
    CommandStation station_;
    TelemetryQueue telemetry_;
    Fd listener_, wakeup_ = open_wakeup();
    std::atomic<bool> stopping_{false};
    std::thread thread_;
    std::list<Client> clients_;
};

}  // namespace hilcam
