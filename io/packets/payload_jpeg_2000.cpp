// JPEG 2000 (ISO/IEC 15444-1, ITU-T T.800) by OpenJPEG: a codestream of one component of the frame's bits, one
// tile, one layer, the reversible 5-3 wavelet; lossless. One thread.

#include <openjpeg.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

#include "io/packets/payload_encoder.h"
#include "io/system/loaded_library.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// The ABI of all releases 2.x.
constexpr const char* kLibrary = "libopenjp2.so.7";
constexpr int kMostResolutions = 6;

#define HILCAM_OPJ_FUNCTION(name) decltype(&opj_##name) name = nullptr
struct Library {
    HILCAM_OPJ_FUNCTION(set_default_encoder_parameters);
    HILCAM_OPJ_FUNCTION(image_create);
    HILCAM_OPJ_FUNCTION(image_destroy);
    HILCAM_OPJ_FUNCTION(create_compress);
    HILCAM_OPJ_FUNCTION(destroy_codec);
    HILCAM_OPJ_FUNCTION(setup_encoder);
    HILCAM_OPJ_FUNCTION(start_compress);
    HILCAM_OPJ_FUNCTION(encode);
    HILCAM_OPJ_FUNCTION(end_compress);
    HILCAM_OPJ_FUNCTION(stream_default_create);
    HILCAM_OPJ_FUNCTION(stream_destroy);
    HILCAM_OPJ_FUNCTION(stream_set_user_data);
    HILCAM_OPJ_FUNCTION(stream_set_write_function);
    HILCAM_OPJ_FUNCTION(stream_set_skip_function);
    HILCAM_OPJ_FUNCTION(stream_set_seek_function);

    Library() {
        const LoadedLibrary library(kLibrary, "outputs.packets.payload: jpeg_2000", "libopenjp2-7");
        library.find(set_default_encoder_parameters, "opj_set_default_encoder_parameters");
        library.find(image_create, "opj_image_create");
        library.find(image_destroy, "opj_image_destroy");
        library.find(create_compress, "opj_create_compress");
        library.find(destroy_codec, "opj_destroy_codec");
        library.find(setup_encoder, "opj_setup_encoder");
        library.find(start_compress, "opj_start_compress");
        library.find(encode, "opj_encode");
        library.find(end_compress, "opj_end_compress");
        library.find(stream_default_create, "opj_stream_default_create");
        library.find(stream_destroy, "opj_stream_destroy");
        library.find(stream_set_user_data, "opj_stream_set_user_data");
        library.find(stream_set_write_function, "opj_stream_set_write_function");
        library.find(stream_set_skip_function, "opj_stream_set_skip_function");
        library.find(stream_set_seek_function, "opj_stream_set_seek_function");
    }
};
#undef HILCAM_OPJ_FUNCTION

void require(bool done, const char* step) {
    if (!done) throw DeviceError(std::string("outputs.packets: OpenJPEG fails to ") + step);
}

// The stream that OpenJPEG writes to: the end of a vector. It seeks back to fill in lengths.
struct Sink {
    std::vector<std::uint8_t>& bytes;
    std::size_t begin, at;

    static Sink& of(void* user) { return *static_cast<Sink*>(user); }
    void reach(std::size_t end) {
        if (bytes.size() < end) bytes.resize(end);
    }
    static OPJ_SIZE_T write(void* from, OPJ_SIZE_T size, void* user) {
        Sink& s = of(user);
        s.reach(s.at + size);
        std::memcpy(s.bytes.data() + s.at, from, size);
        s.at += size;
        return size;
    }
    static OPJ_OFF_T skip(OPJ_OFF_T size, void* user) {
        Sink& s = of(user);
        if (size < 0) return -1;
        s.at += static_cast<std::size_t>(size);
        s.reach(s.at);
        return size;
    }
    static OPJ_BOOL seek(OPJ_OFF_T to, void* user) {
        Sink& s = of(user);
        if (to < 0) return OPJ_FALSE;
        s.at = s.begin + static_cast<std::size_t>(to);
        s.reach(s.at);
        return OPJ_TRUE;
    }
};

class Jpeg2000Encoder : public PayloadEncoder {
  public:
    void encode(const Strip& strip, std::vector<std::uint8_t>& out) override {
        opj_cparameters_t parameters;
        my_.set_default_encoder_parameters(&parameters);
        parameters.irreversible = 0;
        parameters.tcp_numlayers = 1;
        parameters.tcp_rates[0] = 0;  // lossless
        parameters.cp_disto_alloc = 1;
        // A picture of n pixels can be halved until one is left.
        const auto side = static_cast<unsigned>(std::min(strip.width, strip.rows));
        parameters.numresolution = std::min(kMostResolutions, static_cast<int>(std::bit_width(side)));

        const std::unique_ptr<opj_image_t, decltype(my_.image_destroy)> image(image_of(strip),
                                                                              my_.image_destroy);
        require(image != nullptr, "allocate a picture");
        const std::unique_ptr<opj_codec_t, decltype(my_.destroy_codec)> codec(
            my_.create_compress(OPJ_CODEC_J2K), my_.destroy_codec);
        require(codec && my_.setup_encoder(codec.get(), &parameters, image.get()), "set its encoder up");
        const std::unique_ptr<opj_stream_t, decltype(my_.stream_destroy)> stream(
            my_.stream_default_create(OPJ_FALSE), my_.stream_destroy);
        require(stream != nullptr, "open a stream");
        Sink sink{out, out.size(), out.size()};
        my_.stream_set_user_data(stream.get(), &sink, nullptr);
        my_.stream_set_write_function(stream.get(), &Sink::write);
        my_.stream_set_skip_function(stream.get(), &Sink::skip);
        my_.stream_set_seek_function(stream.get(), &Sink::seek);
        require(my_.start_compress(codec.get(), image.get(), stream.get()) &&
                    my_.encode(codec.get(), stream.get()) && my_.end_compress(codec.get(), stream.get()),
                "compress");
    }

  private:
    opj_image_t* image_of(const Strip& strip) const {
        opj_image_cmptparm_t component{};
        component.dx = component.dy = 1;
        component.w = static_cast<OPJ_UINT32>(strip.width);
        component.h = static_cast<OPJ_UINT32>(strip.rows);
        component.prec = static_cast<OPJ_UINT32>(strip.bits);
        opj_image_t* const image = my_.image_create(1, &component, OPJ_CLRSPC_GRAY);
        if (!image) return nullptr;
        image->x1 = component.w;
        image->y1 = component.h;
        std::copy(strip.dn.begin(), strip.dn.end(), image->comps[0].data);
        return image;
    }

    Library my_;
};

}  // namespace

std::unique_ptr<PayloadEncoder> make_jpeg_2000_encoder() { return std::make_unique<Jpeg2000Encoder>(); }

}  // namespace hilcam
