// Any bytes are a command in the cFS dialect, or an answer, or neither; what is one says the same after
// another round trip.

#include <array>

#include "io/commands/cfs_codec.h"
#include "io/commands/command_dialect.h"
#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    const std::span<const std::uint8_t> bytes(data, size);
    std::array<std::uint8_t, kMaxPacketBytes> again;
    for (const bool checksum_required : {false, true}) {
        const DecodedCommand decoded = decode_cfs_command(bytes, checksum_required);
        if (decoded.status != CommandStatus::kAccepted) {
            HILCAM_CHECK(!decoded.reason.empty());
            continue;
        }
        const std::size_t written = encode_cfs_command(decoded.command, decoded.sequence, again);
        const DecodedCommand back = decode_cfs_command(std::span(again).first(written), true);
        HILCAM_CHECK(back.status == CommandStatus::kAccepted && back.sequence == decoded.sequence);
    }
    Acknowledgement acknowledgement;
    decode_cfs_acknowledgement(bytes, acknowledgement);
    Telemetry telemetry;
    if (!decode_cfs_telemetry(bytes, telemetry)) return 0;
    const std::size_t written = encode_cfs_telemetry(telemetry, 0, again);
    HILCAM_CHECK(decode_cfs_telemetry(std::span(again).first(written), telemetry));
    return 0;
}
