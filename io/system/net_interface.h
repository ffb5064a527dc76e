#pragma once
// An IPv4 interface of this machine, by address or by name.

#include <cstdint>
#include <string>

namespace hilcam {

struct NetInterface {
    std::string name;
    std::uint32_t address = 0, mask = 0;  // host order
    std::uint64_t mac = 0;                // 48 bits; made up from the address where the interface has none
    std::uint32_t mtu_bytes = 1500;
};

// Throws InputError that lists the interfaces there are. Any address of 127.0.0.0/8 is on the loopback
// interface.
NetInterface find_interface(const std::string& name_or_address);

}  // namespace hilcam
