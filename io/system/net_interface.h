#pragma once
// An IPv4 interface of this machine, by address or by name.

#include <cstdint>
#include <string>

namespace hilcam {

struct NetInterface {
    std::string name;
    std::uint32_t address = 0, mask = 0;  // host order
    std::uint64_t mac = 0;                // 48 bits; derived from the address if the interface has none
    std::uint32_t mtu_bytes = 1500;
};

// Returns the interface with this name or address. Throws InputError with a list of the interfaces. Every
// address in 127.0.0.0/8 belongs to the loopback interface.
NetInterface find_interface(const std::string& name_or_address);

}  // namespace hilcam
