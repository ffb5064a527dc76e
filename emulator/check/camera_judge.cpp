#include "emulator/check/camera_judge.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "emulator/loop/shutter_timing.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

using Lines = std::vector<std::string>;

// Full wells of camera sensors are in the thousands.
constexpr double kMinWell_e = 500;
// Designers let the converter end near the full well; the gain at power-up may leave a tenth of it.
constexpr double kMinShare = 0.02;
// A black level is usually a few percent of the converter's range; with more than this, little is left for
// light.
constexpr double kMaxBlackShare = 0.5;
// Pixel pitches of silicon: telephones have 0.6 um, infrared arrays 30.
constexpr double kPitch_um[] = {0.5, 40};
// The largest space telescope that looks down is smaller than this, and pinholes of telephones are larger.
constexpr double kWidestLens_m = 1.5, kNarrowestLens_m = 0.1e-3;
// Three standard deviations: a Gaussian has 0.13 % of its values below that.
constexpr double kSigmasBelowBlack = 3;

void judge_well(const CameraSheet& s, const KeyPlaces& places, Lines& out) {
    const double converter_share = s.converter_e / s.well_e;
    const double well_share = (s.well_dn - s.camera.offset_dn) / (s.max_dn - s.camera.offset_dn);
    if (s.well_e < kMinWell_e)
        out.push_back(places.at("camera.full_well_e",
                                fmt::format("camera.full_well_e is {:.4g}: sensors of cameras hold thousands "
                                            "of electrons; is the data sheet's value in ke-?",
                                            s.well_e)));
    else if (converter_share < kMinShare)
        out.push_back(places.at(
            "camera.gain_dn_e",
            fmt::format("the camera's converter ends at {:.4g} e-, {:.2g} % of its full well of {:.4g} e-: "
                        "camera.gain_dn_e "
                        "or gain_db is too high (now {:.4g} DN/e-; {:.3g} DN/e- would take the whole well)",
                        s.converter_e, 100 * converter_share, s.well_e, s.gain_dn_e,
                        s.gain_dn_e * converter_share)));
    else if (well_share < kMinShare)
        out.push_back(places.at(
            "camera.gain_dn_e",
            fmt::format("the camera's full well of {:.4g} e- is {:.3g} DN, {:.2g} % of its converter's "
                        "range: camera.gain_dn_e or gain_db is too low (now {:.4g} DN/e-)",
                        s.well_e, s.well_dn, 100 * well_share, s.gain_dn_e)));
}

// Half a DN is rounded up to the next.
void judge_response(const CameraSheet& s, const KeyPlaces& places, Lines& out) {
    if (s.response_e_s > 0) return;
    out.push_back(
        places.at("camera.quantum_efficiency",
                  "the camera sees no light: camera.quantum_efficiency times camera.transmission is 0"));
}

void judge_black(const CameraSheet& s, const KeyPlaces& places, Lines& out) {
    if (s.camera.offset_dn > kMaxBlackShare * s.max_dn) {
        out.push_back(places.at("camera.offset_dn",
                                fmt::format("camera.offset_dn of {:.6g} leaves {:.6g} DN of {:.6g} for light",
                                            s.camera.offset_dn, s.max_dn - s.camera.offset_dn, s.max_dn)));
        return;
    }
    const double noise_dn = std::hypot(s.dark_shot_e, s.camera.dark_noise_e()) * s.gain_dn_e;
    const double black_dn = s.camera.offset_dn + s.dark_e_s * s.exposure_s * s.gain_dn_e;
    if (black_dn + 0.5 >= kSigmasBelowBlack * noise_dn) return;
    // The mean of max(n, 0), for a Gaussian n about black with this sigma, exceeds black by sigma (phi(x) - x
    // Phi(-x)), x = black / sigma: the integral of -n over n < 0.
    const double x = black_dn / noise_dn;
    const double rise_dn =
        noise_dn * (std::exp(-0.5 * x * x) / std::sqrt(2 * kPi) - 0.5 * x * std::erfc(x / std::sqrt(2.0)));
    out.push_back(places.at(
        "camera.offset_dn",
        fmt::format("camera.offset_dn is {:.4g}, and the noise in the dark {:.3g} DN: values below 0 are "
                    "clipped, which makes dark pixels {:.2g} DN too bright; an offset of {:.0f} prevents it",
                    s.camera.offset_dn, noise_dn, rise_dn, std::ceil(4 * noise_dn))));
}

void judge_period(const CameraSheet& s, const KeyPlaces& places, Lines& out) {
    const ShutterTiming timing(s.camera);
    const double asked_hz = s.camera.frame_rate_hz, done_hz = 1 / timing.period_s(asked_hz, s.exposure_s);
    if (timing.is_fixed() || done_hz > 0.999 * asked_hz) return;
    out.push_back(places.at(
        "camera.frame_rate_hz",
        fmt::format(
            "camera.frame_rate_hz is {:.4g}: camera.exposure_ms of {:.4g} with the shutter's rows allows "
            "{:.4g} frames/s at most",
            asked_hz, 1e3 * s.exposure_s, done_hz)));
}

void judge_optics(const CameraSheet& s, const KeyPlaces& places, Lines& out) {
    const double pitch_um = s.camera.pitch_m * 1e6, lens_m = s.camera.focal_length_m / s.camera.f_number;
    if (pitch_um < kPitch_um[0] || pitch_um > kPitch_um[1])
        out.push_back(places.at(
            "camera.pitch_um",
            fmt::format(
                "camera.pitch_um is {:.4g}: cameras have pixels of {} to {} um; is the decimal point right?",
                pitch_um, kPitch_um[0], kPitch_um[1])));
    if (lens_m > kWidestLens_m)
        out.push_back(
            places.at("camera.focal_length_mm",
                      fmt::format("camera.focal_length_mm of {:.6g} at f/{:.3g} is a lens {:.3g} m wide; in "
                                  "micrometres?",
                                  1e3 * s.camera.focal_length_m, s.camera.f_number, lens_m)));
    if (lens_m < kNarrowestLens_m)
        out.push_back(
            places.at("camera.focal_length_mm",
                      fmt::format("camera.focal_length_mm of {:.4g} at f/{:.3g} is a lens {:.2g} mm wide; in "
                                  "metres?",
                                  1e3 * s.camera.focal_length_m, s.camera.f_number, 1e3 * lens_m)));
}

}  // namespace

std::vector<std::string> judge_camera(const CameraSheet& sheet, bool keeps_rate, const KeyPlaces& places) {
    Lines out;
    judge_response(sheet, places, out);
    judge_well(sheet, places, out);
    judge_black(sheet, places, out);
    judge_optics(sheet, places, out);
    if (keeps_rate) judge_period(sheet, places, out);
    return out;
}

}  // namespace hilcam
