// Any bytes are a simulator's message or a refusal in one line; what follows from them are finite poses, and
// every request is answered.

#include <cmath>

#include "io/vizard_conversation.h"
#include "render/check.h"

namespace {

using namespace hilcam;

void check_one_line(const std::string& text) { HILCAM_CHECK(text.find('\n') == std::string::npos); }

VizardBench bench() {
    VizardBench b;
    b.start = parse_utc("2026-01-01T00:00:00Z");
    b.origin.kind = OriginConfig::Kind::kEarthFixed;
    b.objects = {"target", "bennu"};
    b.cameras = {{{}, 0.4, 256, 192}, {{{1, 2, 3}, {}}, 0.5, 64, 64}};
    return b;
}

VizardConversation::Picture look(const VizardShot& shot) {
    HILCAM_CHECK(shot.camera == 1 || shot.camera == 2);
    for (const PoseCommand& p : shot.poses) {
        HILCAM_CHECK(p.object <= 2 && is_finite(p.motion.pose.position_world_m));
        HILCAM_CHECK(is_finite(p.motion.velocity_world_m_s));
        HILCAM_CHECK(std::abs(norm(p.motion.pose.world_from_body) - 1) < 1e-9);
    }
    return {"picture", {}};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const DecodedVizardUpdate decoded = decode_vizard_update({data, size});
    check_one_line(decoded.refusal);
    VizardWorld world({VizardTime::kMessage, 1e-3, {}}, bench(), check_one_line);
    VizardConversation conversation(world, look);
    const std::string bytes(reinterpret_cast<const char*>(data), size);
    const VizardParts update = conversation.answer({"SIM_UPDATE", "", "", bytes}).parts;
    HILCAM_CHECK(update.size() == 1 && update[0] == (decoded.refusal.empty() ? "OK" : "ERROR"));
    const std::int64_t first = decoded.update.cameras.empty() ? 1 : decoded.update.cameras.front().id;
    for (const std::string& id : {std::to_string(first), std::string("2"), bytes}) {
        const VizardParts image = conversation.answer({"REQUEST_IMAGE_" + id}).parts;
        HILCAM_CHECK(image.size() == 2 && image[0].size() == 4);
    }
    HILCAM_CHECK(!conversation.answer({bytes}).parts.empty());
    HILCAM_CHECK(conversation.answer({"REQUEST_INPUT"}).parts.size() == 2);
    return 0;
}
