#include "io/meshes/data_uri.h"

#include <array>
#include <cstdint>

namespace hilcam {
namespace {

// Values of the letters of base64 and base64url (RFC 4648, sections 4 and 5); -1: not a letter.
constexpr std::array<std::int8_t, 256> kSextets = [] {
    std::array<std::int8_t, 256> values{};
    values.fill(-1);
    for (int i = 0; i < 26; ++i) {
        values[static_cast<std::size_t>('A' + i)] = static_cast<std::int8_t>(i);
        values[static_cast<std::size_t>('a' + i)] = static_cast<std::int8_t>(26 + i);
    }
    for (int i = 0; i < 10; ++i) values[static_cast<std::size_t>('0' + i)] = static_cast<std::int8_t>(52 + i);
    values['+'] = values['-'] = 62;
    values['/'] = values['_'] = 63;
    return values;
}();

std::optional<std::string> decoded_base64(std::string_view text) {
    while (text.ends_with('=')) text.remove_suffix(1);
    std::string out;
    out.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int held = 0;
    for (const char c : text) {
        const int value = kSextets[static_cast<unsigned char>(c)];
        if (value < 0) return {};
        bits = bits << 6 | static_cast<std::uint32_t>(value);
        held += 6;
        if (held < 8) continue;
        held -= 8;
        out += static_cast<char>(bits >> held & 0xFF);
    }
    return out;
}

}  // namespace

std::optional<std::string> decoded_data_uri(std::string_view uri) {
    constexpr std::string_view kMark = ";base64";
    if (!uri.starts_with("data:")) return {};
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(kMark)) return {};
    return decoded_base64(uri.substr(comma + 1));
}

}  // namespace hilcam
