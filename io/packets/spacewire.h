#pragma once
// Space packets as the cargo of SpaceWire packets, for bridges that send what comes over TCP into a SpaceWire
// network: by the CCSDS packet transfer protocol (ECSS-E-ST-50-53C) or as RMAP write commands
// (ECSS-E-ST-50-52C). The link itself, its characters and its flow control are the bridge's.
//
// Neither protocol says where a packet ends; on the link an end-of-packet marker does. In streams and files
// each SpaceWire packet therefore has its length before it, four bytes, big-endian, which do not count
// themselves. A datagram is one packet without a length.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "render/vocabulary/config_field.h"

namespace hilcam {

struct SpaceWireConfig {
    enum class Protocol : std::uint8_t { kCcsds, kRmap };

    Protocol protocol = Protocol::kCcsds;
    std::vector<double> path_address;
    std::int64_t target = 0xFE;
    std::int64_t user_application = 0;
    std::int64_t key = 0;
    std::int64_t initiator = 0xFE;
    std::int64_t address = 0;
    std::int64_t extended_address = 0;
    std::int64_t slots = 1;
    std::int64_t slot_bytes = 65536;
};
Fields fields(SpaceWireConfig& config);
void validate(const SpaceWireConfig& config);
// Returns how many bytes a packet grows by, without the length before it.
std::size_t added_bytes(const SpaceWireConfig& config);

class SpaceWireWrapper {
  public:
    // lengths: a length goes before each packet.
    SpaceWireWrapper(const SpaceWireConfig& config, bool lengths) : config_(config), lengths_(lengths) {}
    // Returns the bytes that are sent for a space packet; valid until the next call.
    std::span<const std::uint8_t> wrap(std::span<const std::uint8_t> packet);

  private:
    void append_rmap(std::span<const std::uint8_t> packet);

    SpaceWireConfig config_;
    bool lengths_;
    std::uint64_t count_ = 0;  // packets so far
    std::vector<std::uint8_t> bytes_;
};

}  // namespace hilcam
