// Any text is a text kernel, from which times, clocks, turns of frames, orientations and instruments can be asked, or refused in one
// line.

#include <string>
#include <string_view>

#include "io/spice/body_orientation.h"
#include "io/spice/instrument_kernel.h"
#include "io/spice/kernel_frames.h"
#include "io/spice/kernel_names.h"
#include "io/spice/spacecraft_clock.h"
#include "io/spice/text_kernel.h"
#include "render/vocabulary/check.h"

namespace {

using namespace hilcam;

template <class F>
void refused_in_one_line(const F& f) {
    try {
        f();
    } catch (const InputError& error) {
        HILCAM_CHECK(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    KernelPool pool;
    refused_in_one_line([&] { read_text_kernel({reinterpret_cast<const char*>(data), size}, "fuzz", pool); });
    refused_in_one_line([&] { (void)leap_seconds_of(pool); });
    EphemerisTime time;
    refused_in_one_line([&] { time = ephemeris_time(pool); });
    refused_in_one_line(
        [&] { (void)SpacecraftClock(pool, -99, time).et_s(SpacecraftClock(pool, -99, time).ticks(1e8)); });
    refused_in_one_line([&] {
        KernelSet set;
        set.pool = pool;
        KernelFrames frames(set);
        FrameTurn turn;
        const int code = frames.require("CAM", "fuzz");
        for (const double et_s : {0.0, -3e8, 1e300}) (void)frames.turn(code, et_s, turn);
    });
    refused_in_one_line([&] { (void)kernel_code(pool, "SHIP"); });
    refused_in_one_line([&] {
        if (const auto body = text_orientation(pool, 401)) (void)body->at(1e8);
    });
    refused_in_one_line([&] { (void)instrument_kernel(pool, "-99100", "fuzz"); });
    return 0;
}
