#pragma once
// Takes the commands of all transports: packets from senders in, acknowledgements out. The transports that
// bring the bytes (commands_udp.h, stream_server.h, commands_usb.h, ...) know nothing about commands.
//
// Commands take effect in order of arrival, whatever their sequence numbers. An `expose`, a `fault` or a
// clock step that repeats an earlier packet of the same sender byte by byte within a second is a
// retransmission: it gets the same answer and is not carried out again.

#include <array>
#include <cstdint>
#include <functional>
#include <list>
#include <mutex>
#include <string>
#include <vector>

#include "io/commands/command_dialect.h"
#include "io/commands/packet_stream.h"
#include "io/commands/sequence_window.h"
#include "io/contract/command.h"

namespace hilcam {

class CommandStation {
  public:
    class Sender;
    // Sends one whole packet to the sender.
    using Answer = std::function<void(std::span<const std::uint8_t> packet)>;
    using Notify = std::function<void(Sender& sender, std::span<const std::uint8_t> packet)>;

    CommandStation(CommandHandler& handler, const DialectConfig& dialect);
    ~CommandStation();

    // --- the transport's thread ---
    //
    // Returns a reference that is valid until close().
    Sender& open(std::string name);
    void close(Sender& sender);
    PacketStream make_stream(std::size_t read_bytes = PacketStream::kReadBytes) const;
    // Takes all complete packets of the stream.
    void take(PacketStream& stream, std::int64_t arrival_monotonic_ns, Sender& sender, const Answer& answer);
    // Takes all packets when no more bytes come: at the end of a datagram or a connection.
    void take_all(PacketStream& stream, std::int64_t arrival_monotonic_ns, Sender& sender,
                  const Answer& answer);
    // Refuses an empty datagram, which cannot be put into a stream.
    void refuse_empty(Sender& sender, const Answer& answer);
    // Sends to every sender that subscribed to this kind.
    void notify(const Telemetry& telemetry, const Notify& notify);
    // Subscribes a sender that has not asked.
    void subscribe(Sender& sender, SubscribeCommand subscription);
    void count_stranger();
    void count_cut_off();

    // --- any thread ---
    CommandReport report() const;
    std::vector<SenderReport> senders() const;

  private:
    void take_packet(std::span<const std::uint8_t> packet, std::int64_t arrival_ns, Sender& sender,
                     const Answer& answer);
    CommandStatus perform(const DecodedCommand& decoded, std::span<const std::uint8_t> packet,
                          std::int64_t arrival_ns, Sender& sender, CommandNotes& notes);
    bool count(std::uint32_t sequence, Sender& sender);

    CommandHandler& handler_;
    DialectConfig dialect_;
    mutable std::mutex mutex_;  // guards all below, also while a command is carried out
    std::list<Sender> senders_;
    CommandReport report_;
};

}  // namespace hilcam
