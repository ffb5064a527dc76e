// Any text is an orbit ephemeris that can be interpolated all over its span, or refused in one line.

#include <string_view>

#include "emulator/motion/ephemeris.h"
#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    try {
        for (const OemSegment& s : read_oem(text, "fuzz"))
            for (const TimeTai time :
                 {s.usable_start, s.usable_start + (s.usable_stop - s.usable_start) / 3, s.usable_stop}) {
                const StateVector state = interpolate_state(s, time);
                HILCAM_CHECK(is_finite(state.position_m) && is_finite(state.velocity_m_s));
            }
    } catch (const InputError& error) {
        HILCAM_CHECK(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
    return 0;
}
