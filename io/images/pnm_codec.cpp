// Netpbm's pictures by own code. stb_image reads only P5 and P6, fills the missing end of a file with
// whatever is in memory, and ignores the sample value of white, so that a picture of 4 or 10 bits would be
// dark.
#include <vector>

#include "io/images/picture_codecs.h"
#include "io/images/pnm_header.h"

namespace hilcam {
namespace {

// Returns the samples of a picture in order.
class PnmSamples {
  public:
    PnmSamples(PictureBytes bytes, const PnmHeader& header)
        : bytes_(bytes), most_(header.most), is_text_(header.is_text), at_(header.data_at) {}

    std::uint32_t next() {
        const std::uint32_t value = is_text_ ? next_word() : next_bytes();
        if (value > most_)
            throw undecodable("a sample is " + std::to_string(value) + ", and its head says that " +
                              std::to_string(most_) + " is white");
        return value;
    }

  private:
    PictureBytes bytes_;
    std::uint32_t most_;
    bool is_text_;
    std::size_t at_;

    std::uint32_t next_word() {
        const auto value = next_pnm_number(bytes_, at_);
        if (value) return *value;
        throw undecodable(at_ < bytes_.size() ? "a sample is no number" : "the file ends too early");
    }
    // Samples above 255 have two bytes, most significant first.
    std::uint32_t next_bytes() {
        const std::size_t size = most_ > 255 ? 2 : 1;
        if (bytes_.size() - at_ < size) throw undecodable("the file ends too early");
        const std::uint32_t first = bytes_[at_], second = size == 2 ? bytes_[at_ + 1] : 0u;
        at_ += size;
        return size == 2 ? first << 8 | second : first;
    }
};

PnmHeader required_header(PictureBytes bytes) {
    const auto header = pnm_header(bytes);
    if (!header) throw undecodable("no head of a PGM or PPM");
    require_few_pixels(header->width, header->height);
    // Every word but the last has at least a digit and a blank.
    const std::uint64_t samples = header->width * header->height * (header->is_color ? 3 : 1);
    const std::uint64_t min_bytes =
        header->is_text ? 2 * samples - 1 : samples * (header->most > 255 ? 2 : 1);
    if (bytes.size() - header->data_at < min_bytes) throw undecodable("the file ends too early");
    return *header;
}

// Returns a sample as one of 255 shades, rounded.
std::uint8_t shade(std::uint32_t value, std::uint32_t most) {
    return static_cast<std::uint8_t>((std::uint64_t{value} * 255 + most / 2) / most);
}

}  // namespace

Texture decode_pnm(PictureBytes bytes) {
    const PnmHeader header = required_header(bytes);
    Texture texture = blank_texture(header.width, header.height);
    PnmSamples samples(bytes, header);
    for (auto& texel : texture.texels) {
        texel[0] = shade(samples.next(), header.most);
        texel[1] = header.is_color ? shade(samples.next(), header.most) : texel[0];
        texel[2] = header.is_color ? shade(samples.next(), header.most) : texel[0];
    }
    return texture;
}

PixelMap decode_pnm_numbers(PictureBytes bytes) {
    const PnmHeader header = required_header(bytes);
    if (header.is_color) throw PictureFault("has 3 channels; accepted: one");
    PixelMap map(static_cast<int>(header.width), static_cast<int>(header.height));
    PnmSamples samples(bytes, header);
    for (float& value : map.all()) value = static_cast<float>(samples.next());
    return map;
}

}  // namespace hilcam
