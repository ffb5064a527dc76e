#include "emulator/clone/raw_frame.h"

#include <spdlog/fmt/fmt.h>

#include "render/vocabulary/check.h"

namespace hilcam {

void decode_raw(std::string_view bytes, const FramesConfig& c, const std::string& name, DnImage& frame) {
    const std::size_t each = c.container_bits == 8 ? 1 : 2, header = static_cast<std::size_t>(c.header_bytes);
    const std::size_t wanted = header + each * frame.pixels();
    if (bytes.size() != wanted)
        throw InputError(fmt::format("{}: found {} bytes; accepted: {}, for {} x {} pixels of {} bytes{}",
                                     name, bytes.size(), wanted, frame.width(), frame.height(), each,
                                     header > 0 ? " after the header" : ""));
    const auto byte = [&](std::size_t i) {
        return static_cast<unsigned>(static_cast<unsigned char>(bytes[i]));
    };
    const bool big = c.byte_order == FramesConfig::ByteOrder::kBig;
    for (std::size_t i = 0; i < frame.pixels(); ++i) {
        const std::size_t at = header + each * i;
        const unsigned value =
            each == 1 ? byte(at) : (big ? byte(at) << 8 | byte(at + 1) : byte(at) | byte(at + 1) << 8);
        frame.all()[i] = static_cast<std::uint16_t>(value >> c.shift_bits);
    }
}

}  // namespace hilcam
