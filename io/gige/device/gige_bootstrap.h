#pragma once
// The registers that describe the device: version, identity, addresses, the place of its description,
// capabilities.

#include "io/gige/device/gige_core.h"

namespace hilcam {

class GigeBootstrap {
  public:
    GigeBootstrap(GigeCore& core, std::function<void(std::uint32_t before)> config_changed);

    // Adds the description, plain and zipped; both must outlive the register file. Its URLs contain the
    // sizes.
    void add_description(std::span<const std::uint8_t> xml, std::span<const std::uint8_t> zip);
    // Adds another camera's description, zipped alone.
    void add_description(const std::string& name, std::span<const std::uint8_t> zip, std::uint32_t place);
    void reset();
    // Switches on what is on after power-up.
    void power_up();

  private:
    void add_identity();
    void add_addresses();
    void add_capabilities();
    gvcp::Status write_gvcp_config(std::uint64_t value);

    GigeCore& core_;
    std::function<void(std::uint32_t)> config_changed_;
    std::uint32_t persistent_ip_ = 0, persistent_mask_ = 0, persistent_gateway_ = 0;
    std::uint32_t ip_configuration_ = 0;
};

}  // namespace hilcam
