#pragma once
// The stream channel's registers: destination, size, rate and form of packets. Also the test packet, by which
// a client finds out which size its path carries.

#include "io/gige/device/gige_core.h"

namespace hilcam {

class GigeTransport {
  public:
    static constexpr std::uint32_t kMinPacketBytes = 576, kMaxPacketBytes = 16384, kPacketStep = 4;

    // closed: called when a client sets the stream's port to 0.
    GigeTransport(GigeCore& core, std::function<void()> closed);

    void set_source_port(std::uint16_t port) { source_port_ = port; }
    void close();
    void reset();

  private:
    gvcp::Status write_port(std::uint64_t value);
    gvcp::Status write_packet_size(std::uint64_t value);
    gvcp::Status write_config(std::uint64_t value);
    gvcp::Status write_extended_ids(std::uint64_t value);
    void fire_test_packet(std::uint32_t packet_bytes);
    void add_throughput();

    GigeCore& core_;
    std::function<void()> closed_;
    std::uint16_t source_port_ = 0;
};

}  // namespace hilcam
