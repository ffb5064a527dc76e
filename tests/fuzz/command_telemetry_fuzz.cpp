// Any bytes are a telemetry packet or none; what is one says the same after another round trip.

#include <algorithm>
#include <array>

#include "io/command_dialect.h"
#include "render/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    const std::span<const std::uint8_t> bytes(data, size);
    Acknowledgement acknowledgement;
    decode_acknowledgement(bytes, acknowledgement);
    // With a right CRC, too: mutations seldom find one.
    std::array<std::uint8_t, kMostPacketBytes> sealed;
    std::copy_n(data, std::min(size, sealed.size()), sealed.begin());
    std::size_t sealed_bytes = 0;
    if (size > 8 && size <= sealed.size())
        sealed_bytes = seal_packet(read_packet_header(bytes), size - 8, sealed);
    for (const auto packet : {bytes, std::span<const std::uint8_t>(sealed).first(sealed_bytes)}) {
        Telemetry telemetry, back;
        if (!decode_telemetry(packet, telemetry)) continue;
        std::array<std::uint8_t, kMostPacketBytes> again, third;
        const std::size_t written = encode_telemetry(telemetry, 0, again);
        HILCAM_CHECK(decode_telemetry(std::span(again).first(written), back));
        HILCAM_CHECK(back.index() == telemetry.index());
        HILCAM_CHECK(encode_telemetry(back, 0, third) == written);
        HILCAM_CHECK(std::equal(again.begin(), again.begin() + written, third.begin()));
        if (const auto* report = std::get_if<FrameReport>(&telemetry))
            HILCAM_CHECK(report->camera == packet[8]);
    }
    return 0;
}
