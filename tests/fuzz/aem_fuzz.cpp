// Any text is an attitude ephemeris whose attitudes are rotations, or refused in one line.

#include <cmath>
#include <string_view>

#include "emulator/motion/ephemeris.h"
#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    try {
        for (const AemSegment& s : read_aem(text, "fuzz"))
            for (const AttitudeSample& a : s.attitudes) {
                HILCAM_CHECK(std::abs(norm(a.reference_from_body) - 1) < 1e-6 &&
                             is_finite(a.rate_body_rad_s));
                if (a.time < s.usable_start || s.usable_stop < a.time) continue;
                const ReferenceAttitude found = interpolate_attitude(s, a.time);
                HILCAM_CHECK(std::abs(norm(found.reference_from_body) - 1) < 1e-6);
            }
    } catch (const InputError& error) {
        HILCAM_CHECK(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
    return 0;
}
