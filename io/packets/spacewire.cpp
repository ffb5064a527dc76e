#include "io/packets/spacewire.h"

#include <cmath>

#include "io/packets/rmap.h"
#include "io/system/bytes.h"

namespace hilcam {
namespace {

using Protocol = SpaceWireConfig::Protocol;

constexpr std::uint8_t kCcsdsProtocol = 0x02;  // protocol identifier (ECSS-E-ST-50-51C)
constexpr std::size_t kLengthBytes = 4, kCcsdsHeaderBytes = 4;
constexpr double kMostPathBytes = 31;  // SpaceWire path addresses are port numbers, 0 to 31

Field only(const SpaceWireConfig& c, Protocol protocol, Field field) {
    field.why_idle = [&c, protocol]() -> std::string {
        if (c.protocol == protocol) return {};
        return protocol == Protocol::kRmap ? "only protocol rmap has it" : "only protocol ccsds has it";
    };
    return field;
}

std::uint8_t byte(std::int64_t value) { return static_cast<std::uint8_t>(value); }

}  // namespace

Fields fields(SpaceWireConfig& c) {
    const auto rmap = [&c](Field field) { return only(c, Protocol::kRmap, std::move(field)); };
    return {
        choice("protocol", c.protocol, {"ccsds", "rmap"},
               "ccsds: CCSDS packet transfer protocol (ECSS-E-ST-50-53C); rmap: RMAP write commands without "
               "reply (ECSS-E-ST-50-52C)"),
        numbers("path_address", c.path_address, 1, {0, kMostPathBytes}, {0, 12},
                "ports on the way to the target, one byte each before the packet, as [3, 1]"),
        integer("target", c.target, {32, 255}, "target logical address; 254: any"),
        only(
            c, Protocol::kCcsds,
            integer("user_application", c.user_application, {0, 255}, "value of the user application field")),
        rmap(integer("key", c.key, {0, 255}, "key of the write command")),
        rmap(integer("initiator", c.initiator, {32, 255}, "initiator logical address; 254: any")),
        rmap(integer("address", c.address, {0, 4294967295.0}, "memory address of the first slot")),
        rmap(integer("extended_address", c.extended_address, {0, 255}, "bits 32 to 39 of the address")),
        rmap(integer("slots", c.slots, {0, 1e6},
                     "number of slots in the memory, which packets fill in turn; 0: all go to the one "
                     "address, without increment, as into a FIFO")),
        rmap(integer("slot_bytes", c.slot_bytes, {1, 16777215}, "distance of one slot from the next")),
    };
}

void validate(const SpaceWireConfig& c) {
    for (const double port : c.path_address)
        if (port != std::floor(port))
            throw refused_key("path_address", "a number that is not whole", "whole numbers, 0 to 31");
    const double last =
        static_cast<double>(c.address) + static_cast<double>(c.slots) * static_cast<double>(c.slot_bytes);
    if (c.protocol == Protocol::kRmap && c.slots > 0 && last > 4294967296.0)
        throw refused_key("slots",
                          std::to_string(c.slots) + " slots of " + std::to_string(c.slot_bytes) + " bytes",
                          "slots that end at address 4294967295 at most");
}

std::size_t added_bytes(const SpaceWireConfig& c) {
    return c.path_address.size() +
           (c.protocol == Protocol::kCcsds ? kCcsdsHeaderBytes : kRmapWriteHeaderBytes + 1);
}

std::span<const std::uint8_t> SpaceWireWrapper::wrap(std::span<const std::uint8_t> packet) {
    bytes_.assign(lengths_ ? kLengthBytes : 0, 0);
    for (const double port : config_.path_address) bytes_.push_back(static_cast<std::uint8_t>(port));
    if (config_.protocol == Protocol::kRmap) {
        append_rmap(packet);
    } else {
        // Target, protocol identifier, a reserved byte, user application, packet.
        bytes_.insert(bytes_.end(),
                      {byte(config_.target), kCcsdsProtocol, 0, byte(config_.user_application)});
        bytes_.insert(bytes_.end(), packet.begin(), packet.end());
    }
    if (lengths_) ByteWriter(bytes_).u32(bytes_.size() - kLengthBytes);
    ++count_;
    return bytes_;
}

void SpaceWireWrapper::append_rmap(std::span<const std::uint8_t> packet) {
    const std::uint64_t slot = config_.slots > 0 ? count_ % static_cast<std::uint64_t>(config_.slots) : 0;
    const std::uint64_t address =
        static_cast<std::uint64_t>(config_.address) + slot * static_cast<std::uint64_t>(config_.slot_bytes);
    append_rmap_write({.target = byte(config_.target),
                       .key = byte(config_.key),
                       .initiator = byte(config_.initiator),
                       .transaction = static_cast<std::uint16_t>(count_),
                       .extended_address = byte(config_.extended_address),
                       .address = static_cast<std::uint32_t>(address),
                       .increment = config_.slots > 0},
                      packet, bytes_);
}

}  // namespace hilcam
