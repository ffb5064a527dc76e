#include "io/packets/pixel_code.h"

#include <algorithm>
#include <array>

namespace hilcam {
namespace {

struct Codes {
    int bits;
    bool packed;
    std::uint32_t mono;
    std::array<std::uint32_t, 4> mosaic;  // GR, RG, GB, BG
};
constexpr std::array<Codes, 8> kCodes = {{
    {8, false, 0x01080001, {0x01080008, 0x01080009, 0x0108000A, 0x0108000B}},
    {10, false, 0x01100003, {0x0110000C, 0x0110000D, 0x0110000E, 0x0110000F}},
    {12, false, 0x01100005, {0x01100010, 0x01100011, 0x01100012, 0x01100013}},
    {14, false, 0x01100025, {0x01100109, 0x0110010A, 0x0110010B, 0x0110010C}},
    {16, false, 0x01100007, {0x0110002E, 0x0110002F, 0x01100030, 0x01100031}},
    {10, true, 0x010A0046, {0x010A0056, 0x010A0058, 0x010A0054, 0x010A0052}},
    {12, true, 0x010C0047, {0x010C0057, 0x010C0059, 0x010C0055, 0x010C0053}},
    {14, true, 0x010E0104, {0x010E0105, 0x010E0106, 0x010E0107, 0x010E0108}},
}};
constexpr std::array<BayerPattern, 4> kPatterns = {"GRBG", "RGGB", "GBRG", "BGGR"};

const Codes& codes_of(int bits, bool packed) {
    for (const Codes& codes : kCodes)
        if (codes.packed == packed && codes.bits >= bits) return codes;
    return codes_of(bits, false);
}

}  // namespace

std::uint32_t pixel_code(int bits, bool packed, BayerPattern pattern) {
    const bool has_own = packed && (bits == 10 || bits == 12 || bits == 14);
    const Codes& codes = codes_of(std::min(bits, 16), has_own);
    const auto* const at = std::find(kPatterns.begin(), kPatterns.end(), pattern);
    return at == kPatterns.end() ? codes.mono
                                 : codes.mosaic[static_cast<std::size_t>(at - kPatterns.begin())];
}

}  // namespace hilcam
