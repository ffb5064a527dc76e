// Any bytes are a simulator's message or a refusal in one line; what follows from them are finite poses, and
// every request is answered. As bytes of a connection they are followed the same in pieces as at once.

#include <algorithm>
#include <cmath>

#include "io/vizard/vizard_conversation.h"
#include "io/vizard/zmtp_meter.h"
#include "render/vocabulary/check.h"

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

// After a greeting as it should be; byte by byte it finds what it finds at once.
void check_meter(std::span<const std::uint8_t> frames) {
    std::vector<std::uint8_t> greeting(64);
    greeting[0] = 0xFF, greeting[9] = 0x7F, greeting[10] = 3;
    ZmtpMeter at_once({100, 4}), by_bytes({100, 4});
    HILCAM_CHECK(at_once.take(greeting) && by_bytes.take(greeting));
    bool good = true;
    for (std::size_t i = 0; i < frames.size(); ++i) good = by_bytes.take(frames.subspan(i, 1));
    HILCAM_CHECK(at_once.take(frames) == good);
    HILCAM_CHECK(at_once.messages() == by_bytes.messages());
    HILCAM_CHECK(at_once.announced_bytes() == by_bytes.announced_bytes());
    HILCAM_CHECK(at_once.unfinished_bytes() <= std::min<std::uint64_t>(100, at_once.announced_bytes()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    check_meter({data, size});
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
    HILCAM_CHECK(conversation.answer({"REQUEST_IMAGE"}).parts.size() == 2);
    HILCAM_CHECK(!conversation.answer({bytes}).parts.empty());
    HILCAM_CHECK(conversation.answer({"REQUEST_INPUT"}).parts.size() == 2);
    return 0;
}
