// CCSDS 121.0-B-3 by libaec.
//
// Parameters, which a decoder has to know: samples of n = `bits` bits, unsigned; unit-delay predictor; blocks
// of J = 16 samples; a reference sample every r = 128 blocks; no restricted options. The samples are the
// strip's rows one after another.

#include <libaec.h>

#include <string>

#include "io/packets/payload_encoder.h"
#include "io/system/loaded_library.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// The first ABI, that of Debian 12 and 13.
constexpr const char* kLibrary = "libaec.so.0";
constexpr unsigned kBlock_samples = 16, kReferenceInterval_blocks = 128;

class Ccsds121Encoder : public PayloadEncoder {
  public:
    Ccsds121Encoder() {
        LoadedLibrary(kLibrary, "outputs.packets.payload: ccsds_121", "libaec0")
            .find(encode_, "aec_buffer_encode");
    }

    void encode(const Strip& strip, std::vector<std::uint8_t>& out) override {
        // Samples of up to 8 bits are bytes to libaec, larger ones two bytes, least significant first.
        const bool bytes_each = strip.bits <= 8;
        if (bytes_each) small_.assign(strip.dn.begin(), strip.dn.end());
        // A block that does not compress grows by its option's 5 bits; so 3 bytes for 16 samples are enough.
        const std::size_t before = out.size(), most = 2 * strip.dn.size() + strip.dn.size() / 5 + 256;
        out.resize(before + most);
        aec_stream stream{};
        stream.next_in = bytes_each ? small_.data() : reinterpret_cast<const unsigned char*>(strip.dn.data());
        stream.avail_in = strip.dn.size() * (bytes_each ? 1 : 2);
        stream.next_out = out.data() + before;
        stream.avail_out = most;
        stream.bits_per_sample = static_cast<unsigned>(strip.bits);
        stream.block_size = kBlock_samples;
        stream.rsi = kReferenceInterval_blocks;
        stream.flags = AEC_DATA_PREPROCESS;
        const int status = encode_(&stream);
        if (status != AEC_OK || stream.total_in != strip.dn.size() * (bytes_each ? 1 : 2))
            throw DeviceError("outputs.packets: libaec reports error " + std::to_string(status));
        out.resize(before + stream.total_out);
    }

  private:
    decltype(&aec_buffer_encode) encode_ = nullptr;
    std::vector<std::uint8_t> small_;
};

}  // namespace

std::unique_ptr<PayloadEncoder> make_ccsds_121_encoder() { return std::make_unique<Ccsds121Encoder>(); }

}  // namespace hilcam
