#include "io/images/pnm_header.h"

#include <limits>

namespace hilcam {
namespace {

bool is_blank(std::uint8_t c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
bool is_digit(std::uint8_t c) { return c >= '0' && c <= '9'; }

void skip_blanks(std::span<const std::uint8_t> bytes, std::size_t& at) {
    while (at < bytes.size()) {
        if (bytes[at] == '#') {
            while (at < bytes.size() && bytes[at] != '\n' && bytes[at] != '\r') ++at;
        } else if (is_blank(bytes[at])) {
            ++at;
        } else {
            return;
        }
    }
}

}  // namespace

std::optional<std::uint32_t> next_pnm_number(std::span<const std::uint8_t> bytes, std::size_t& at) {
    skip_blanks(bytes, at);
    if (at >= bytes.size() || !is_digit(bytes[at])) return {};
    std::uint64_t value = 0;
    for (; at < bytes.size() && is_digit(bytes[at]); ++at) {
        value = 10 * value + (bytes[at] - std::uint64_t{'0'});
        if (value > std::numeric_limits<std::uint32_t>::max()) return {};
    }
    return static_cast<std::uint32_t>(value);
}

std::optional<PnmHeader> pnm_header(std::span<const std::uint8_t> bytes) {
    if (bytes.size() < 3 || bytes[0] != 'P' || !(is_blank(bytes[2]) || bytes[2] == '#')) return {};
    const std::uint8_t kind = bytes[1];
    if (kind != '2' && kind != '3' && kind != '5' && kind != '6') return {};
    std::size_t at = 2;
    const auto width = next_pnm_number(bytes, at);
    const auto height = width ? next_pnm_number(bytes, at) : std::nullopt;
    const auto most = height ? next_pnm_number(bytes, at) : std::nullopt;
    if (!most || *most < 1 || *most > 65535) return {};
    // Exactly one blank ends the header: the next byte may be a sample that looks like a blank.
    if (at >= bytes.size() || !is_blank(bytes[at])) return {};
    return PnmHeader{kind == '3' || kind == '6', kind == '2' || kind == '3', *width, *height, *most, at + 1};
}

}  // namespace hilcam
