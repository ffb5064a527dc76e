#pragma once
// The header of Netpbm's grey and colour pictures (PGM, PPM): "P5 640 480 255", with blanks and comments
// between the words (Netpbm, "PGM Format Specification" and "PPM Format Specification", 2016).

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace hilcam {

struct PnmHeader {
    bool is_color = false;  // P3 and P6; P2 and P5 are grey
    bool is_text = false;   // P2 and P3 write samples as words
    std::uint64_t width = 0, height = 0;
    std::uint32_t most = 0;   // sample of white, 1 to 65535
    std::size_t data_at = 0;  // offset of the samples
};

// Returns nothing when the bytes do not begin with such a header. Any thread.
std::optional<PnmHeader> pnm_header(std::span<const std::uint8_t> bytes);

// Reads the number at `at`, after blanks and comments (# to the end of the line), and moves `at` behind it.
// Returns nothing when there is no number below 2^32.
std::optional<std::uint32_t> next_pnm_number(std::span<const std::uint8_t> bytes, std::size_t& at);

}  // namespace hilcam
