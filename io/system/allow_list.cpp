#include "io/system/allow_list.h"

#include <algorithm>
#include <charconv>

#include "io/system/fd.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

constexpr const char* kAccepted = "; accepted: an IPv4 address, a network as 10.0.0.0/8, or any";

}  // namespace

bool is_loopback(std::uint32_t address) { return address >> 24 == 127; }

AllowList::AllowList(const std::vector<std::string>& entries, const std::string& address,
                     const std::string& key) {
    for (const std::string& entry : entries) {
        if (entry == "any") {
            any_ = true;
            continue;
        }
        const std::size_t slash = entry.find('/');
        unsigned bits = 32;
        if (slash != std::string::npos) {
            const char* const last = entry.data() + entry.size();
            const auto [end, error] = std::from_chars(entry.data() + slash + 1, last, bits);
            if (error != std::errc{} || end != last || bits > 32)
                throw KeyError(key + ".allow", "found " + in_quotes(entry) + kAccepted);
        }
        Network network;
        try {
            network.address = parse_ipv4(entry.substr(0, slash), key);
        } catch (const InputError&) {
            throw KeyError(key + ".allow", "found " + in_quotes(entry) + kAccepted);
        }
        network.mask = bits == 0 ? 0 : ~std::uint32_t{0} << (32 - bits);
        if ((network.address & ~network.mask) != 0)
            throw KeyError(key + ".allow", "found " + in_quotes(entry) + "; its network is " +
                                               format_ipv4(network.address & network.mask) + "/" +
                                               std::to_string(bits));
        networks_.push_back(network);
    }
    if (!entries.empty()) return;
    if (!is_loopback(parse_ipv4(address, key + ".address")))
        throw KeyError(key + ".address", "found " + in_quotes(address) + ", which others can reach; give '" +
                                             key +
                                             ".allow' too: addresses and networks that may send, or [any]");
    any_ = true;
}

bool AllowList::allows(std::uint32_t address) const {
    return any_ || std::any_of(networks_.begin(), networks_.end(),
                               [&](const Network& n) { return (address & n.mask) == n.address; });
}

Field allow_field(std::vector<std::string>& allow) {
    return texts("allow", allow,
                 "senders whose packets are accepted: IPv4 addresses and networks, or any; required when the "
                 "address is not loopback");
}

}  // namespace hilcam
