#pragma once
// The senders of a UDP port, by their addresses. The last sixteen are remembered, each for a minute after its
// last packet, with their counts and their subscriptions to telemetry.

#include <netinet/in.h>

#include <list>

#include "io/commands/command_station.h"

namespace hilcam {

class UdpPeers {
  public:
    explicit UdpPeers(CommandStation& station) : station_(station) {}

    // Returns the sender at an address, which has just sent. A new one replaces the one that was silent for
    // longest.
    CommandStation::Sender& at(const sockaddr_in& address, std::int64_t now_ns);
    void forget_silent(std::int64_t now_ns);
    void forget_all();
    // Returns nullptr for a sender that is not remembered.
    const sockaddr_in* address_of(const CommandStation::Sender& sender) const;

  private:
    struct Peer {
        sockaddr_in address{};
        CommandStation::Sender* sender = nullptr;
        std::int64_t heard_ns = 0;
    };
    void forget_first();

    CommandStation& station_;
    std::list<Peer> peers_;  // most recently heard last
};

}  // namespace hilcam
