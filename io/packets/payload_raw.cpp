#include "io/packets/payload_encoder.h"
#include "sensor/packing.h"

namespace hilcam {
namespace {

class RawEncoder : public PayloadEncoder {
  public:
    explicit RawEncoder(Payload payload) : payload_(payload) {}

    void encode(const Strip& strip, std::vector<std::uint8_t>& out) override {
        const PixelLayout layout{payload_ == Payload::kPacked ? Packing::kPfnc : Packing::kNone, strip.bits,
                                 16};
        const std::size_t before = out.size(), bytes = packed_bytes(strip.dn.size(), layout);
        out.resize(before + bytes);
        const std::span<std::uint8_t> room = std::span(out).subspan(before);
        if (payload_ != Payload::kRawBigEndian) return pack(strip.dn, layout, room);
        for (std::size_t i = 0; i < strip.dn.size(); ++i) {
            room[2 * i] = static_cast<std::uint8_t>(strip.dn[i] >> 8);
            room[2 * i + 1] = static_cast<std::uint8_t>(strip.dn[i] & 0xFF);
        }
    }

  private:
    Payload payload_;
};

}  // namespace

std::unique_ptr<PayloadEncoder> make_raw_encoder(Payload payload) {
    return std::make_unique<RawEncoder>(payload);
}

}  // namespace hilcam
