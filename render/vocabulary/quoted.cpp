#include "render/vocabulary/quoted.h"

#include <cstdint>

namespace hilcam {
namespace {

constexpr std::size_t kMaxShown_bytes = 60;

struct Character {
    char32_t code = 0;
    std::size_t bytes = 1;
    bool valid = false;
};

// The first character of a text that is not empty (RFC 3629, section 4: the shortest form only, no
// surrogates, nothing above 10FFFF). One that is not valid has one byte.
Character first_of(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
    const std::uint8_t lead = byte(0);
    if (lead < 0x80) return {lead, 1, true};
    const std::size_t bytes = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    if (lead < 0xC2 || lead > 0xF4 || text.size() < bytes) return {};
    char32_t code = lead & (0x7Fu >> bytes);
    for (std::size_t i = 1; i < bytes; ++i) {
        if ((byte(i) & 0xC0) != 0x80) return {};
        code = code << 6 | (byte(i) & 0x3Fu);
    }
    constexpr char32_t kMin[] = {0, 0, 0x80, 0x800, 0x10000};
    if (code < kMin[bytes] || code > 0x10FFFF || (code >= 0xD800 && code < 0xE000)) return {};
    return {code, bytes, true};
}

// Unicode 15, categories Cc, Zl and Zp, and the explicit directional formatting of its Annex 9.
bool is_obeyed(char32_t code) {
    return code < 0x20 || (code >= 0x7F && code < 0xA0) || (code >= 0x2028 && code <= 0x202E) ||
           (code >= 0x2066 && code <= 0x2069);
}

}  // namespace

std::string harmless(std::string_view text) {
    std::string out;
    while (!text.empty()) {
        const Character c = first_of(text);
        if (c.valid && !is_obeyed(c.code))
            out += text.substr(0, c.bytes);
        else
            out += ' ';
        text.remove_prefix(c.bytes);
    }
    return out;
}

std::string shortened(std::string_view text) {
    if (text.size() <= kMaxShown_bytes) return harmless(text);
    std::size_t end = kMaxShown_bytes - 3;
    // Back to the start of a character, by at most one character's length.
    for (int i = 0; i < 3 && (static_cast<std::uint8_t>(text[end]) & 0xC0) == 0x80; ++i) --end;
    return harmless(text.substr(0, end)) + "...";
}

std::string in_quotes(std::string_view text) { return std::string("'").append(shortened(text)).append("'"); }

}  // namespace hilcam
