#pragma once
// The IPv4 addresses and networks that may talk to a listening socket. A socket on a loopback address needs
// no list. Any other address does, so that a missing line never opens a camera to a network.

#include <cstdint>
#include <string>
#include <vector>

#include "render/vocabulary/config_field.h"

namespace hilcam {

class AllowList {
  public:
    // Entries: "10.0.0.5", "10.0.0.0/8", "any". An empty list is allowed for loopback addresses only and
    // admits every sender that reaches the socket. key: the transport's name in messages ("commands.udp").
    // Throws InputError, mostly a KeyError with a key that begins with `key`.
    AllowList(const std::vector<std::string>& entries, const std::string& address, const std::string& key);

    // True when this address may send. Host order. Any thread.
    bool allows(std::uint32_t address) const;

  private:
    struct Network {
        std::uint32_t address = 0, mask = 0;
    };
    std::vector<Network> networks_;
    bool any_ = false;
};

// True for an address in 127.0.0.0/8. Host order.
bool is_loopback(std::uint32_t address);
// Returns the list as a key of a transport's configuration.
Field allow_field(std::vector<std::string>& allow);

}  // namespace hilcam
