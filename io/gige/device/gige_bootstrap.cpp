#include "io/gige/device/gige_bootstrap.h"

#include <cstdio>

#include "io/gige/device/gige_registers.h"

namespace hilcam {

namespace b = bootstrap;
using gvcp::Status;

namespace {

// GEV 2.0, the newest version with all its mandatory parts implemented here.
constexpr std::uint32_t kVersion = 2u << 16 | 0;
constexpr std::uint32_t kBigEndianTransmitterUtf8 = 1u << 31 | 1u;
constexpr std::uint32_t kPersistent = 1, kLinkLocal = 4;  // ways to get an address
constexpr std::uint32_t kPendingTimeout_ms = 60'000;      // the slowest answer that a fault can cause

constexpr std::uint32_t kGvcpCan =
    b::gvcp_can::kUserName | b::gvcp_can::kSerial | b::gvcp_can::kHeartbeatDisable |
    b::gvcp_can::kPrimaryApplication | b::gvcp_can::kExtendedStatus11 | b::gvcp_can::kSwitchover |
    b::gvcp_can::kUnconditionalAction | b::gvcp_can::kPtp | b::gvcp_can::kExtendedStatus20 |
    b::gvcp_can::kScheduledAction | b::gvcp_can::kAction | b::gvcp_can::kPendingAnswer |
    b::gvcp_can::kEventData | b::gvcp_can::kEvent | b::gvcp_can::kPacketResend | b::gvcp_can::kWriteMemory |
    b::gvcp_can::kConcatenation;

constexpr std::uint32_t kGvcpConfigBits =
    b::gvcp_config::kHeartbeatDisable | b::gvcp_config::kPendingAnswer | b::gvcp_config::kExtendedStatus11 |
    b::gvcp_config::kUnconditionalAction | b::gvcp_config::kExtendedStatus20 | b::gvcp_config::kPtpEnable;

}  // namespace

GigeBootstrap::GigeBootstrap(GigeCore& core, std::function<void(std::uint32_t)> config_changed)
    : core_(core), config_changed_(std::move(config_changed)) {
    add_identity();
    add_addresses();
    add_capabilities();
}

void GigeBootstrap::add_identity() {
    GigeRegisterFile& r = core_.registers;
    const GigeIdentity& id = core_.identity;
    r.constant(b::kVersion, kVersion);
    r.constant(b::kDeviceMode, kBigEndianTransmitterUtf8);
    r.constant(b::kMacHigh, id.mac >> 32);
    r.constant(b::kMacLow, id.mac & 0xFFFFFFFF);
    r.text(b::kVendor, 32, id.vendor);
    r.text(b::kModel, 32, id.model);
    r.text(b::kDeviceVersion, 32, id.version);
    r.text(b::kInfo, 48, "emulated spacecraft camera");
    r.text(b::kSerial, 16, id.serial);
    r.text(b::kUserName, 16, id.user_name, true);
}

// The address is the machine's, and how the machine got it is not ours to choose. Clients may still set a
// persistent address; the choice is kept, and readable, until the program ends.
void GigeBootstrap::add_addresses() {
    GigeRegisterFile& r = core_.registers;
    GigeIdentity& id = core_.identity;
    ip_configuration_ = kLinkLocal;
    r.constant(b::kIpSupported, kPersistent | kLinkLocal);
    r.number(
        b::kIpCurrent, [this] { return ip_configuration_; },
        [this](std::uint64_t value) {
            if (value & ~std::uint64_t{kPersistent | kLinkLocal}) return Status::kInvalidParameter;
            // Link-local addresses are always on.
            ip_configuration_ = static_cast<std::uint32_t>(value) | kLinkLocal;
            return Status::kSuccess;
        });
    r.number(b::kIp, [&id] { return id.ip; });
    r.number(b::kMask, [&id] { return id.mask; });
    r.number(b::kGateway, [&id] { return id.gateway; });
    persistent_ip_ = id.ip, persistent_mask_ = id.mask, persistent_gateway_ = id.gateway;
    r.variable(b::kPersistentIp, persistent_ip_, {});
    r.variable(b::kPersistentMask, persistent_mask_, {});
    r.variable(b::kPersistentGateway, persistent_gateway_, {});
    r.constant(b::kInterfaces, 1);
    r.constant(b::kLinkSpeed, id.link_speed_mbit_s);
    r.constant(b::kActiveLinks, 1);
    r.constant(b::kLinkCapability, 1);  // a single link
    r.constant(b::kLinkConfig, 0);
}

void GigeBootstrap::add_capabilities() {
    GigeRegisterFile& r = core_.registers;
    r.constant(b::kStreamChannels, 1);
    // Source port register; legacy 16-bit block ids and 64-bit ones.
    r.constant(b::kStreamCapability, 1u << 31 | 1u << 30);
    r.constant(b::kMessageCapability, 1u << 31);  // source port register
    std::uint32_t can = kGvcpCan;
    if (core_.identity.link_speed_mbit_s) can |= b::gvcp_can::kLinkSpeed;
    if (core_.identity.clock_source == ClockSource::kFree) can &= ~b::gvcp_can::kPtp;
    r.constant(b::kGvcpCapability, can);
    r.constant(b::kDiscoveryDelay, 0);
    r.number(
        b::kGvcpConfig, [this] { return core_.gvcp_config; },
        [this](std::uint64_t v) { return write_gvcp_config(v); });
    r.constant(b::kPendingTimeout, kPendingTimeout_ms);
}

Status GigeBootstrap::write_gvcp_config(std::uint64_t value) {
    if (value & ~std::uint64_t{kGvcpConfigBits}) return Status::kInvalidParameter;
    if (value & b::gvcp_config::kPtpEnable && core_.identity.clock_source == ClockSource::kFree)
        return Status::kInvalidParameter;
    const std::uint32_t before = core_.gvcp_config;
    core_.gvcp_config = static_cast<std::uint32_t>(value);
    if (config_changed_) config_changed_(before);
    return Status::kSuccess;
}

void GigeBootstrap::add_description(std::span<const std::uint8_t> xml, std::span<const std::uint8_t> zip) {
    GigeRegisterFile& r = core_.registers;
    const auto url = [&](std::uint32_t place, const char* ending, std::uint32_t address, std::size_t bytes) {
        char text[64];
        std::snprintf(text, sizeof text, "Local:///hilcam.%s;%X;%zX", ending, address, bytes);
        r.text(place, 512, text);
    };
    url(b::kXmlUrl, "zip", kZipAddress, zip.size());
    url(b::kSecondXmlUrl, "xml", kXmlAddress, xml.size());
    r.memory(kZipAddress, zip);
    r.memory(kXmlAddress, xml);
}

void GigeBootstrap::add_description(const std::string& name, std::span<const std::uint8_t> zip,
                                    std::uint32_t place) {
    char text[160];
    std::snprintf(text, sizeof text, "Local:%.64s.zip;%X;%zX", name.c_str(), place, zip.size());
    core_.registers.text(b::kXmlUrl, 512, text);
    core_.registers.text(b::kSecondXmlUrl, 512, "");
    core_.registers.memory(place, zip);
}

void GigeBootstrap::reset() { write_gvcp_config(0); }

void GigeBootstrap::power_up() {
    if (core_.identity.ptp_at_power_up) write_gvcp_config(b::gvcp_config::kPtpEnable);
}

}  // namespace hilcam
