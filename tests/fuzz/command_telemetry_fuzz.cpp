// Any bytes are a telemetry packet, an acknowledgement or none; what is one says the same after another round
// trip.

#include <algorithm>
#include <array>

#include "io/commands/command_dialect.h"
#include "render/vocabulary/check.h"

using namespace hilcam;

// Reasons come back as far as they travel.
static void check_acknowledgement(std::span<const std::uint8_t> packet) {
    Acknowledgement answer, back;
    if (!decode_acknowledgement(packet, answer)) return;
    std::array<std::uint8_t, kMaxPacketBytes> again;
    const std::size_t written = encode_acknowledgement(answer, 0, again);
    HILCAM_CHECK(written <= kMaxAcknowledgeBytes);
    HILCAM_CHECK(decode_acknowledgement(std::span(again).first(written), back));
    HILCAM_CHECK(back.sequence == answer.sequence && back.token == answer.token);
    HILCAM_CHECK(back.clock.has_value() == answer.clock.has_value());
    HILCAM_CHECK(!back.clock || back.clock->stands_at == answer.clock->stands_at);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::span<const std::uint8_t> bytes(data, size);
    // With a right CRC, too: mutations seldom find one.
    std::array<std::uint8_t, kMaxPacketBytes> sealed;
    std::copy_n(data, std::min(size, sealed.size()), sealed.begin());
    std::size_t sealed_bytes = 0;
    if (size > 8 && size <= sealed.size())
        sealed_bytes = seal_packet(read_packet_header(bytes), size - 8, sealed);
    for (const auto packet : {bytes, std::span<const std::uint8_t>(sealed).first(sealed_bytes)}) {
        check_acknowledgement(packet);
        Telemetry telemetry, back;
        if (!decode_telemetry(packet, telemetry)) continue;
        std::array<std::uint8_t, kMaxPacketBytes> again, third;
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
