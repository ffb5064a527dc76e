// Any bytes are pictures or are refused, the same in pieces as at once; a picture's missing pixels are 0.

#include <vector>

#include "render/vocabulary/check.h"
#include "tools/image_packets/hilcam_image.hpp"

namespace {

using namespace hilcam_image;

constexpr std::size_t kMostPixels = 4096;

struct Seen {
    std::vector<std::uint64_t> frames;
    std::uint64_t sum = 0;
};

void look(void* context, const Picture& p) {
    auto& seen = *static_cast<Seen*>(context);
    const std::size_t count = std::size_t{p.header.width} * p.header.height;
    HILCAM_CHECK(count > 0 && count <= kMostPixels);
    std::size_t missing = 0;
    for (std::size_t i = 0; i < count; ++i) {
        HILCAM_CHECK(p.valid[i] <= 1 && (p.valid[i] == 1 || p.pixels[i] == 0));
        missing += p.valid[i] == 0 ? 1u : 0u;
        seen.sum = seen.sum * 31 + p.pixels[i];
    }
    HILCAM_CHECK(missing == p.missing_pixels);
    seen.frames.push_back(p.header.frame);
}

bool decode(void*, const Packet& head, const std::uint8_t* bytes, std::size_t count, std::uint16_t* pixels) {
    HILCAM_CHECK(head.first_row + head.rows <= head.height);
    for (std::size_t i = 0; i < std::size_t{head.rows} * head.width; ++i) pixels[i] = bytes[i % count];
    return count % 2 == 0;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    PictureReceiver at_once(0x110, kMostPixels, decode), in_pieces(0x110, kMostPixels, decode);
    Seen one, other;
    at_once.take(data, size, look, &one);
    for (std::size_t at = 0; at < size; at += 13)
        in_pieces.take(data + at, std::min<std::size_t>(13, size - at), look, &other);
    HILCAM_CHECK(one.frames == other.frames && one.sum == other.sum);
    HILCAM_CHECK(at_once.counts().skipped_bytes == in_pieces.counts().skipped_bytes);
    HILCAM_CHECK(at_once.counts().unused == in_pieces.counts().unused);
    Packet packet;
    if (read_packet(data, size, packet) == Fault::kNone)
        HILCAM_CHECK(packet.data >= data && packet.data + packet.data_bytes <= data + size);
    return 0;
}
