// Reads a file of image packets, or standard input, by tools/image_packets/hilcam_image.hpp, and writes each
// frame's pixels into a folder as FRAME.raw, U16 in the processor's order.
//
//     image_packets_reader APID FOLDER < packets.bin

#include <cstdio>
#include <cstdlib>
#include <string>

#include "tools/image_packets/hilcam_image.hpp"

namespace {

void write_picture(void* folder, const hilcam_image::Picture& picture) {
    const std::string name =
        *static_cast<const std::string*>(folder) + "/" + std::to_string(picture.header.frame) + ".raw";
    const std::size_t pixels = std::size_t{picture.header.width} * picture.header.height;
    std::FILE* const file = std::fopen(name.c_str(), "wb");
    if (file == nullptr || std::fwrite(picture.pixels, 2, pixels, file) != pixels) std::exit(1);
    std::fclose(file);
    std::printf("%llu %zu %u\n", static_cast<unsigned long long>(picture.header.frame),
                picture.missing_pixels, picture.missing_packets);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    hilcam_image::PictureReceiver receiver(static_cast<std::uint16_t>(std::atoi(argv[1])), 4096 * 4096);
    std::string folder = argv[2];
    std::vector<std::uint8_t> bytes(12345);
    for (std::size_t got = 0; (got = std::fread(bytes.data(), 1, bytes.size(), stdin)) > 0;)
        receiver.take(bytes.data(), got, &write_picture, &folder);
    return receiver.counts().refused == 0 && receiver.counts().unused == 0 ? 0 : 1;
}
