#pragma once
// Where the commands of all transports are taken: packets of a sender in, acknowledgements to it out. What
// brings the bytes (commands_udp.h, stream_server.h, commands_usb.h, ...) knows nothing of commands.
//
// Commands take effect in the order they arrive, whatever their sequence numbers. An `expose`, a `fault` or a
// clock's step that repeats an earlier packet of its sender byte by byte within a second is a retry, or the
// network's doing: it is answered as the first was, and not done again.

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
    // Gets one whole packet for the sender.
    using Answer = std::function<void(std::span<const std::uint8_t> packet)>;
    using Notify = std::function<void(Sender& sender, std::span<const std::uint8_t> packet)>;

    CommandStation(CommandHandler& handler, const DialectConfig& dialect);
    ~CommandStation();

    // --- the transport's thread ---
    // A reference that stays until close().
    Sender& open(std::string name);
    void close(Sender& sender);
    PacketStream make_stream(std::size_t read_bytes = PacketStream::kReadBytes) const;
    // All packets that are whole by now.
    void take(PacketStream& stream, std::int64_t arrival_monotonic_ns, Sender& sender, const Answer& answer);
    // The same, and the bytes end here: at the end of a datagram, of a connection.
    void take_all(PacketStream& stream, std::int64_t arrival_monotonic_ns, Sender& sender,
                  const Answer& answer);
    // What cannot even be given to a stream: an empty datagram.
    void refuse_empty(Sender& sender, const Answer& answer);
    // To every sender that subscribed to this kind.
    void notify(const Telemetry& telemetry, const Notify& notify);
    // Frame reports and housekeeping from now on, unasked.
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
    mutable std::mutex mutex_;  // of all below, also while a command is carried out
    std::list<Sender> senders_;
    CommandReport report_;
};

}  // namespace hilcam
