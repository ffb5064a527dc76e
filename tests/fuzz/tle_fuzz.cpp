// Any text is two-line element sets that SGP4 can be asked about, or refused in one line.

#include <cmath>
#include <string_view>

#include "emulator/motion/trajectories.h"
#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    try {
        for (const Tle& tle :
             read_tles(text, "fuzz", size % 2 ? TleChecksum::kVerify : TleChecksum::kIgnore)) {
            HILCAM_CHECK(std::isfinite(tle.bstar_per_er) && tle.mean_motion_rad_min > 0 &&
                         tle.eccentricity < 1);
            const auto trajectory = make_tle(tle, 3600, "fuzz");
            const WorldFrame frame(tle.epoch, {});
            HILCAM_CHECK(is_finite(trajectory->at({frame, {}}).position_m));
        }
    } catch (const InputError& error) {
        HILCAM_CHECK(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
    return 0;
}
