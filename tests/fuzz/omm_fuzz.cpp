// Any text is mean elements that SGP4 can be asked about, in whatever form an OMM has, or refused in one line.

#include <cmath>
#include <string_view>

#include "emulator/motion/trajectories.h"
#include "io/files/omm_file.h"
#include "render/vocabulary/check.h"

namespace {

using namespace hilcam;

void ask(const ElementSet& set) {
    if (!set.refusal.empty()) return;
    HILCAM_CHECK(std::isfinite(set.bstar_per_er) && set.mean_motion_rad_min > 0 && set.eccentricity < 1);
    const auto trajectory = make_tle(set, 3600);
    const WorldFrame frame(set.epoch, {});
    HILCAM_CHECK(is_finite(trajectory->at({frame, {}}).position_m));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    // Damage must not hide a form from its reader: each is tried in its turn where the first characters tell none.
    const OmmForm form = omm_form_of(text).value_or(static_cast<OmmForm>(size % 4));
    try {
        for (const ElementSet& set : read_omm(text, "fuzz", form)) ask(set);
    } catch (const InputError& error) {
        HILCAM_CHECK(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
    return 0;
}
