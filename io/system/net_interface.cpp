#include "io/system/net_interface.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netpacket/packet.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <cstring>
#include <memory>

#include "io/system/fd.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

std::uint32_t address_in(const sockaddr* a) {
    return a ? ntohl(reinterpret_cast<const sockaddr_in*>(a)->sin_addr.s_addr) : 0;
}

std::uint64_t mac_of(const ifaddrs* list, const std::string& name) {
    for (const ifaddrs* i = list; i; i = i->ifa_next) {
        if (!i->ifa_addr || i->ifa_addr->sa_family != AF_PACKET || name != i->ifa_name) continue;
        const auto* link = reinterpret_cast<const sockaddr_ll*>(i->ifa_addr);
        std::uint64_t mac = 0;
        for (int k = 0; k < 6; ++k) mac = mac << 8 | link->sll_addr[k];
        return mac;
    }
    return 0;
}

std::uint32_t mtu_of(const std::string& name) {
    const Fd any(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    ifreq request{};
    std::strncpy(request.ifr_name, name.c_str(), IFNAMSIZ - 1);
    const bool told = any && ioctl(any.get(), SIOCGIFMTU, &request) == 0 && request.ifr_mtu > 0;
    return told ? static_cast<std::uint32_t>(request.ifr_mtu) : NetInterface{}.mtu_bytes;
}

}  // namespace

NetInterface find_interface(const std::string& wanted) {
    ifaddrs* list = nullptr;
    if (getifaddrs(&list) != 0) throw DeviceError("network interfaces cannot be listed");
    const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> owner(list, freeifaddrs);
    in_addr parsed{};
    const bool is_address = inet_pton(AF_INET, wanted.c_str(), &parsed) == 1;
    const std::uint32_t address = ntohl(parsed.s_addr);
    std::string known;
    for (const ifaddrs* i = list; i; i = i->ifa_next) {
        if (!i->ifa_addr || i->ifa_addr->sa_family != AF_INET) continue;
        const std::uint32_t own = address_in(i->ifa_addr);
        known += std::string(known.empty() ? "" : ", ") + i->ifa_name + " (" + format_ipv4(own) + ")";
        const bool loopback = (i->ifa_flags & IFF_LOOPBACK) && is_address && address >> 24 == 127;
        if (!(is_address ? own == address || loopback : wanted == i->ifa_name)) continue;
        NetInterface found{i->ifa_name, loopback ? address : own, address_in(i->ifa_netmask),
                           mac_of(list, i->ifa_name), mtu_of(i->ifa_name)};
        // Locally administered (bit 1 of the first byte) and unique per address.
        if (found.mac == 0) found.mac = 0x020000000000ull | found.address;
        return found;
    }
    throw InputError("interface " + in_quotes(wanted) + " does not exist; accepted: " + known);
}

}  // namespace hilcam
