// JPEG-LS (ISO/IEC 14495-1, ITU-T T.87) by CharLS: one component of the frame's bits, lossless, default
// parameters, without a SPIFF header.

#include <charls/charls.h>

#include <string>

#include "io/packets/payload_encoder.h"
#include "io/system/loaded_library.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// The major version whose header is compiled is the library's ABI.
const std::string kLibrary = "libcharls.so." + std::to_string(CHARLS_VERSION_MAJOR);
const std::string kPackage = "libcharls" + std::to_string(CHARLS_VERSION_MAJOR);

struct Library {
    decltype(&charls_jpegls_encoder_create) create = nullptr;
    decltype(&charls_jpegls_encoder_destroy) destroy = nullptr;
    decltype(&charls_jpegls_encoder_set_frame_info) set_frame_info = nullptr;
    decltype(&charls_jpegls_encoder_set_destination_buffer) set_destination = nullptr;
    decltype(&charls_jpegls_encoder_encode_from_buffer) encode = nullptr;
    decltype(&charls_jpegls_encoder_get_bytes_written) bytes_written = nullptr;

    Library() {
        const LoadedLibrary library(kLibrary, "outputs.packets.payload: jpeg_ls", kPackage);
        library.find(create, "charls_jpegls_encoder_create");
        library.find(destroy, "charls_jpegls_encoder_destroy");
        library.find(set_frame_info, "charls_jpegls_encoder_set_frame_info");
        library.find(set_destination, "charls_jpegls_encoder_set_destination_buffer");
        library.find(encode, "charls_jpegls_encoder_encode_from_buffer");
        library.find(bytes_written, "charls_jpegls_encoder_get_bytes_written");
    }
};

template <class Status>
void require(Status status) {
    if (static_cast<int>(status) != 0)
        throw DeviceError("outputs.packets: CharLS reports error " +
                          std::to_string(static_cast<int>(status)));
}

class JpegLsEncoder : public PayloadEncoder {
  public:
    void encode(const Strip& strip, std::vector<std::uint8_t>& out) override {
        // An encoder is good for one picture.
        const std::unique_ptr<charls_jpegls_encoder, decltype(library_.destroy)> encoder(library_.create(),
                                                                                         library_.destroy);
        if (!encoder) throw DeviceError("outputs.packets: CharLS has no memory for an encoder");
        const charls_frame_info info{static_cast<std::uint32_t>(strip.width),
                                     static_cast<std::uint32_t>(strip.rows), strip.bits, 1};
        require(library_.set_frame_info(encoder.get(), &info));
        // Samples of up to 8 bits are bytes to CharLS, larger ones 16-bit words of the machine.
        const bool bytes_each = strip.bits <= 8;
        if (bytes_each) small_.assign(strip.dn.begin(), strip.dn.end());
        // T.87 limits a code word to 4 times the bits that a sample has; noise takes little more than its bits.
        const std::size_t before = out.size(), most = 4 * strip.dn.size() + 1024;
        out.resize(before + most);
        require(library_.set_destination(encoder.get(), out.data() + before, most));
        if (bytes_each)
            require(library_.encode(encoder.get(), small_.data(), small_.size(), 0));
        else
            require(library_.encode(encoder.get(), strip.dn.data(), strip.dn.size_bytes(), 0));
        std::size_t written = 0;
        require(library_.bytes_written(encoder.get(), &written));
        out.resize(before + written);
    }

  private:
    Library library_;
    std::vector<std::uint8_t> small_;
};

}  // namespace

std::unique_ptr<PayloadEncoder> make_jpeg_ls_encoder() { return std::make_unique<JpegLsEncoder>(); }

}  // namespace hilcam
