#include "io/commands/functionfs_descriptors.h"

#include <linux/usb/functionfs.h>

namespace hilcam {
namespace {

// USB is little-endian.
class LittleEndian {
  public:
    LittleEndian& u8(unsigned value) { return number(value, 1); }
    LittleEndian& u16(unsigned value) { return number(value, 2); }
    LittleEndian& u32(unsigned value) { return number(value, 4); }
    LittleEndian& text(const std::string& text) {
        bytes_.insert(bytes_.end(), text.begin(), text.end());
        return u8(0);
    }
    std::vector<std::uint8_t> with_length_at(std::size_t at) {
        for (std::size_t i = 0; i < 4; ++i)
            bytes_[at + i] = static_cast<std::uint8_t>(bytes_.size() >> (8 * i));
        return std::move(bytes_);
    }

  private:
    LittleEndian& number(unsigned value, unsigned count) {
        for (unsigned i = 0; i < count; ++i) bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
        return *this;
    }
    std::vector<std::uint8_t> bytes_;
};

void add_endpoint(LittleEndian& out, unsigned address, unsigned packet_bytes, bool super_speed) {
    out.u8(USB_DT_ENDPOINT_SIZE).u8(USB_DT_ENDPOINT).u8(address).u8(USB_ENDPOINT_XFER_BULK);
    out.u16(packet_bytes).u8(0);
    if (super_speed) out.u8(USB_DT_SS_EP_COMP_SIZE).u8(USB_DT_SS_ENDPOINT_COMP).u8(0).u8(0).u16(0);
}

// The controller assigns its own endpoint numbers.
void add_interface(LittleEndian& out, unsigned packet_bytes, bool super_speed = false) {
    out.u8(USB_DT_INTERFACE_SIZE).u8(USB_DT_INTERFACE).u8(0).u8(0).u8(2);
    out.u8(USB_CLASS_VENDOR_SPEC).u8(0).u8(0).u8(1);  // the name is string 1
    add_endpoint(out, 1 | USB_DIR_OUT, packet_bytes, super_speed);
    add_endpoint(out, 2 | USB_DIR_IN, packet_bytes, super_speed);
}

}  // namespace

std::vector<std::uint8_t> functionfs_descriptors() {
    LittleEndian out;
    out.u32(FUNCTIONFS_DESCRIPTORS_MAGIC_V2).u32(0);
    out.u32(FUNCTIONFS_HAS_FS_DESC | FUNCTIONFS_HAS_HS_DESC | FUNCTIONFS_HAS_SS_DESC);
    out.u32(3).u32(3).u32(5);  // descriptors at each speed
    add_interface(out, 64);
    add_interface(out, 512);
    add_interface(out, 1024, true);
    return out.with_length_at(4);
}

std::vector<std::uint8_t> functionfs_strings(const std::string& interface_name) {
    LittleEndian out;
    out.u32(FUNCTIONFS_STRINGS_MAGIC).u32(0).u32(1).u32(1);  // one string, one language
    out.u16(0x0409).text(interface_name);
    return out.with_length_at(4);
}

}  // namespace hilcam
