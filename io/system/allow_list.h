#pragma once
// The list of those who may talk to a listening socket: IPv4 addresses and networks. Loopback needs no list;
// any other address does, so that nobody opens a camera to a network by leaving a line out.

#include <cstdint>
#include <string>
#include <vector>

#include "render/vocabulary/config_field.h"

namespace hilcam {

class AllowList {
  public:
    // Entries: "10.0.0.5", "10.0.0.0/8", "any". Empty: any sender that reaches the socket, for loopback
    // addresses only. `key` names the transport in messages ("commands.udp"). Throws InputError, mostly a KeyError
    // whose key begins with `key`.
    AllowList(const std::vector<std::string>& entries, const std::string& address, const std::string& key);

    // Host order. Any thread.
    bool allows(std::uint32_t address) const;

  private:
    struct Network {
        std::uint32_t address = 0, mask = 0;
    };
    std::vector<Network> networks_;
    bool any_ = false;
};

// "127.0.0.0/8", host order.
bool is_loopback(std::uint32_t address);
// The list as a key of a transport's configuration.
Field allow_field(std::vector<std::string>& allow);

}  // namespace hilcam
