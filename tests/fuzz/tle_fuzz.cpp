// Any text is two-line element sets that SGP4 can be asked about, or refused in one line.

#include <cmath>
#include <string_view>

#include "emulator/motion/trajectories.h"
#include "io/files/tle_file.h"
#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    try {
        for (const ElementSet& set :
             read_tles(text, "fuzz", size % 2 ? TleChecksum::kVerify : TleChecksum::kIgnore)) {
            if (!set.refusal.empty()) continue;
            HILCAM_CHECK(std::isfinite(set.bstar_per_er) && set.mean_motion_rad_min > 0 &&
                         set.eccentricity < 1);
            const auto trajectory = make_tle(set, 3600);
            const WorldFrame frame(set.epoch, {});
            HILCAM_CHECK(is_finite(trajectory->at({frame, {}}).position_m));
        }
    } catch (const InputError& error) {
        HILCAM_CHECK(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
    return 0;
}
