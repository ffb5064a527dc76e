#pragma once
// A file that `hilcam-camera-face record` wrote of a real camera: a line `# hilcam registers 1`, then an
// address and bytes a line, as `0x0000a104 00000280`. What follows a # is a remark.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace hilcam {

inline constexpr std::size_t kMaxRegistersBytes = std::size_t{16} << 20;

struct RegisterRun {
    std::uint32_t address = 0;
    std::vector<std::uint8_t> bytes{};
};

// Throws InputError with the line: no such first line, a line of another form, an address that is there
// twice.
std::vector<RegisterRun> registers_of(std::string_view text, const std::string& name);
// Reads pairs of hexadecimal digits; empty: the text has others, or none.
std::vector<std::uint8_t> bytes_of_hex(std::string_view text);

}  // namespace hilcam
