#include "io/files/text_lines.h"

#include <array>

namespace hilcam {
namespace {

struct OddBlank {
    std::string_view bytes, name;
};
// Unicode's blanks (category Zs, The Unicode Standard 15, table 6-2) and zero-width ones, in UTF-8.
constexpr std::array<OddBlank, 18> kOddBlanks = {{{"\xC2\xA0", "U+00A0, a non-breaking blank"},
                                                  {"\xE2\x80\xAF", "U+202F, a narrow non-breaking blank"},
                                                  {"\xE2\x80\x80", "U+2000, a blank of half a width"},
                                                  {"\xE2\x80\x81", "U+2001, a wide blank"},
                                                  {"\xE2\x80\x82", "U+2002, a blank of half a width"},
                                                  {"\xE2\x80\x83", "U+2003, a wide blank"},
                                                  {"\xE2\x80\x84", "U+2004, a blank of a third of a width"},
                                                  {"\xE2\x80\x85", "U+2005, a blank of a quarter of a width"},
                                                  {"\xE2\x80\x86", "U+2006, a blank of a sixth of a width"},
                                                  {"\xE2\x80\x87", "U+2007, a blank as wide as a digit"},
                                                  {"\xE2\x80\x88", "U+2008, a blank as wide as a point"},
                                                  {"\xE2\x80\x89", "U+2009, a thin blank"},
                                                  {"\xE2\x80\x8A", "U+200A, a hair's blank"},
                                                  {"\xE2\x80\x8B", "U+200B, a blank of no width"},
                                                  {"\xE2\x81\x9F", "U+205F, a blank of formulas"},
                                                  {"\xE3\x80\x80", "U+3000, an ideograph's blank"},
                                                  {"\xEF\xBB\xBF", "U+FEFF, a byte-order mark"},
                                                  {"\xE1\x9A\x80", "U+1680, an ogham blank"}}};

bool is_tail(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

}  // namespace

std::string odd_blank_in(std::string_view text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (static_cast<signed char>(text[i]) >= 0) continue;
        for (const OddBlank& blank : kOddBlanks)
            if (text.substr(i).starts_with(blank.bytes)) return std::string(blank.name);
        // In Latin 1 this byte is a character; in UTF-8 it continues one.
        if (text[i] == '\xA0' && (i == 0 || static_cast<signed char>(text[i - 1]) >= 0))
            return "byte A0, a non-breaking blank";
        while (i + 1 < text.size() && is_tail(text[i + 1])) ++i;
    }
    return {};
}

TextLines::TextLines(std::string_view text, std::string name) : rest_(text), name_(std::move(name)) {
    if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
    if (rest_.starts_with("\xFF\xFE") || rest_.starts_with("\xFE\xFF"))
        throw InputError(name_ + ": is UTF-16; accepted: UTF-8 or ASCII");
}

}  // namespace hilcam
