// Any bytes are a command or a refusal; a command has finite numbers and says the same after another round
// trip.

#include <array>
#include <cmath>
#include <cstring>

#include "io/commands/command_codec.h"
#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    const std::span<const std::uint8_t> bytes(data, size);
    Acknowledgement acknowledgement;
    decode_acknowledgement(bytes, acknowledgement);
    const DecodedCommand decoded = decode_command(bytes);
    if (decoded.status != CommandStatus::kAccepted) {
        HILCAM_CHECK(!decoded.reason.empty());
        return 0;
    }
    if (const auto* pose = std::get_if<PoseCommand>(&decoded.command)) {
        HILCAM_CHECK(is_finite(pose->motion.pose.position_world_m));
        HILCAM_CHECK(std::abs(norm(pose->motion.pose.world_from_body) - 1) < 1e-9);
    }
    std::array<std::uint8_t, kMaxCommandBytes> again;
    const std::size_t written = encode_command(decoded.command, decoded.sequence, again);
    const DecodedCommand back = decode_command(std::span(again).first(written));
    HILCAM_CHECK(back.status == CommandStatus::kAccepted && back.sequence == decoded.sequence);
    HILCAM_CHECK(back.command.index() == decoded.command.index());
    return 0;
}
