// Any text is a rising table of leap seconds, or refused in one line.

#include <string_view>

#include "io/files/leap_seconds_file.h"
#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    try {
        for (const LeapSecond& leap : read_leap_seconds(text, "fuzz").table)
            HILCAM_CHECK(leap.year >= 1972 && leap.month >= 1 && leap.month <= 12 &&
                         leap.tai_minus_utc_s >= 10);
    } catch (const InputError& error) {
        HILCAM_CHECK(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
    return 0;
}
