#pragma once
// The descriptors that a FunctionFS device gives to the kernel: one vendor-specific interface with a bulk OUT
// and a bulk IN endpoint, at full, high and super speed (linux/usb/functionfs.h, USB 2.0 9.6, USB 3.2 9.6).
// Pure functions.

#include <cstdint>
#include <string>
#include <vector>

namespace hilcam {

// Returns the descriptors, which are written to ep0 first, before the strings. ep1 is the OUT endpoint, ep2
// the IN endpoint.
std::vector<std::uint8_t> functionfs_descriptors();
// Returns the strings: the interface's name, in US English.
std::vector<std::uint8_t> functionfs_strings(const std::string& interface_name);

}  // namespace hilcam
