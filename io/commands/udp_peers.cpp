#include "io/commands/udp_peers.h"

#include <arpa/inet.h>

#include <algorithm>
#include <string>

#include "io/system/fd.h"

namespace hilcam {
namespace {

constexpr std::size_t kMaxPeers = 16;
constexpr std::int64_t kSilence_ns = 60'000'000'000;

std::string text_of(const sockaddr_in& a) {
    return format_ipv4(ntohl(a.sin_addr.s_addr)) + ":" + std::to_string(ntohs(a.sin_port));
}

}  // namespace

CommandStation::Sender& UdpPeers::at(const sockaddr_in& address, std::int64_t now_ns) {
    forget_silent(now_ns);
    const auto known = std::find_if(peers_.begin(), peers_.end(), [&](const Peer& p) {
        return p.address.sin_addr.s_addr == address.sin_addr.s_addr && p.address.sin_port == address.sin_port;
    });
    if (known != peers_.end()) {
        peers_.splice(peers_.end(), peers_, known);
    } else {
        if (peers_.size() == kMaxPeers) forget_first();
        peers_.push_back({address, &station_.open(text_of(address)), now_ns});
    }
    peers_.back().heard_ns = now_ns;
    return *peers_.back().sender;
}

void UdpPeers::forget_silent(std::int64_t now_ns) {
    while (!peers_.empty() && now_ns - peers_.front().heard_ns > kSilence_ns) forget_first();
}

void UdpPeers::forget_all() {
    while (!peers_.empty()) forget_first();
}

void UdpPeers::forget_first() {
    station_.close(*peers_.front().sender);
    peers_.pop_front();
}

const sockaddr_in* UdpPeers::address_of(const CommandStation::Sender& sender) const {
    for (const Peer& peer : peers_)
        if (peer.sender == &sender) return &peer.address;
    return nullptr;
}

}  // namespace hilcam
