#include "io/system/text_mark.h"

#include <cstdint>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// True for a text with first two letters of 16 bits or more: a mark in either byte order, or two letters each
// beside a zero.
bool has_wide_letters(std::string_view text) {
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) return true;
    if (text.size() < 4) return false;
    const auto is_zero = [&](std::size_t at) { return text[at] == '\0'; };
    return (!is_zero(0) && is_zero(1) && is_zero(3)) || (is_zero(0) && is_zero(2) && !is_zero(3));
}

void add_utf8(std::uint32_t letter, std::string& out) {
    if (letter < 0x80) {
        out += static_cast<char>(letter);
        return;
    }
    const int more = letter < 0x800 ? 1 : letter < 0x10000 ? 2 : 3;
    constexpr unsigned kFirst[] = {0, 0xC0, 0xE0, 0xF0};
    out += static_cast<char>(kFirst[more] | letter >> 6 * more);
    for (int i = more - 1; i >= 0; --i) out += static_cast<char>(0x80 | (letter >> 6 * i & 0x3F));
}

std::string utf8_of_utf16(std::string_view text, bool big) {
    constexpr std::uint32_t kNoLetter = 0xFFFD;
    const auto unit = [&](std::size_t at) {
        const auto a = static_cast<std::uint8_t>(text[at]), b = static_cast<std::uint8_t>(text[at + 1]);
        return static_cast<std::uint32_t>(big ? a << 8 | b : b << 8 | a);
    };
    std::string out;
    for (std::size_t at = 0; at + 1 < text.size(); at += 2) {
        std::uint32_t letter = unit(at);
        const bool is_first = letter >= 0xD800 && letter < 0xDC00,
                   is_second = letter >= 0xDC00 && letter < 0xE000;
        const std::uint32_t second = is_first && at + 3 < text.size() ? unit(at + 2) : 0;
        if (second >= 0xDC00 && second < 0xE000) {
            letter = 0x10000 + ((letter - 0xD800) << 10) + (second - 0xDC00);
            at += 2;
        } else if (is_first || is_second) {
            letter = kNoLetter;
        }
        add_utf8(letter, out);
    }
    return out;
}

}  // namespace

std::string in_utf8(std::string_view text) {
    if (text.starts_with("\xFE\xFF")) return utf8_of_utf16(text.substr(2), true);
    if (text.starts_with("\xFF\xFE")) return utf8_of_utf16(text.substr(2), false);
    if (has_wide_letters(text)) return utf8_of_utf16(text, text[0] == '\0');
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    return std::string(text);
}

std::string_view without_mark(std::string_view text, const std::string& name) {
    if (has_wide_letters(text))
        throw InputError(name +
                         ": found a text of wide letters (UTF-16 or UTF-32); accepted: UTF-8, as which "
                         "editors can save it");
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    return text;
}

}  // namespace hilcam
