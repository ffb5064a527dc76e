#include "emulator/check/camera_judge.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "emulator/loop/shutter_timing.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

using Lines = std::vector<std::string>;

// Sensors of cameras hold thousands.
constexpr double kMinWell_e = 500;
// Designers let the converter end near the full well; a gain at power-up may leave a tenth of it.
constexpr double kMinShare = 0.02;
// Below black a Gaussian has 0.13 % of its values beyond three standard deviations.
constexpr double kSigmasBelowBlack = 3;

void judge_well(const CameraSheet& s, Lines& out) {
    const double converter_share = s.converter_e / s.well_e;
    const double well_share = (s.well_dn - s.camera.offset_dn) / (s.most_dn - s.camera.offset_dn);
    if (s.well_e < kMinWell_e)
        out.push_back(
            fmt::format("camera.full_well_e is {:.4g}: sensors of cameras hold thousands of electrons; does "
                        "the data sheet count in ke-?",
                        s.well_e));
    else if (converter_share < kMinShare)
        out.push_back(fmt::format(
            "the camera's converter ends at {:.4g} e-, {:.2g} % of its full well of {:.4g} e-: "
            "camera.gain_dn_e "
            "or gain_db is too high (now {:.4g} DN/e-; {:.3g} DN/e- would take the whole well)",
            s.converter_e, 100 * converter_share, s.well_e, s.gain_dn_e, s.gain_dn_e * converter_share));
    else if (well_share < kMinShare)
        out.push_back(fmt::format(
            "the camera's full well of {:.4g} e- is {:.3g} DN, {:.2g} % of what its converter takes: "
            "camera.gain_dn_e or gain_db is too low (now {:.4g} DN/e-)",
            s.well_e, s.well_dn, 100 * well_share, s.gain_dn_e));
}

// Half a DN is rounded up to the next.
void judge_black(const CameraSheet& s, Lines& out) {
    const double noise_dn = std::hypot(s.dark_shot_e, s.camera.dark_noise_e()) * s.gain_dn_e;
    const double black_dn = s.camera.offset_dn + s.dark_e_s * s.exposure_s * s.gain_dn_e;
    if (black_dn + 0.5 >= kSigmasBelowBlack * noise_dn) return;
    // The mean of max(n, 0), n a Gaussian about black with this sigma, is above black by
    // sigma (phi(x) - x Phi(-x)), x = black / sigma: the integral of -n over n < 0.
    const double x = black_dn / noise_dn;
    const double rise_dn =
        noise_dn * (std::exp(-0.5 * x * x) / std::sqrt(2 * kPi) - 0.5 * x * std::erfc(x / std::sqrt(2.0)));
    out.push_back(fmt::format(
        "camera.offset_dn is {:.4g}, and the noise in the dark {:.3g} DN: what lies below 0 is cut "
        "off, which makes dark pixels {:.2g} DN too bright; {:.0f} would keep it",
        s.camera.offset_dn, noise_dn, rise_dn, std::ceil(4 * noise_dn)));
}

void judge_period(const CameraSheet& s, Lines& out) {
    const ShutterTiming timing(s.camera);
    const double asked_hz = s.camera.frame_rate_hz, done_hz = 1 / timing.period_s(asked_hz, s.exposure_s);
    if (timing.is_fixed() || done_hz > 0.999 * asked_hz) return;
    out.push_back(fmt::format(
        "camera.frame_rate_hz is {:.4g}, and camera.exposure_ms with the shutter's rows leaves {:.4g}",
        asked_hz, done_hz));
}

}  // namespace

std::vector<std::string> judge_camera(const CameraSheet& sheet, bool keeps_rate) {
    Lines out;
    judge_well(sheet, out);
    judge_black(sheet, out);
    if (keeps_rate) judge_period(sheet, out);
    return out;
}

}  // namespace hilcam
