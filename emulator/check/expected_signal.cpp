#include "emulator/check/expected_signal.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// An object with fewer lit pixels than this counts as a point of light.
constexpr double kPoint_px = 4;

// Returns the mean over the whole disk, which is 2/3 when fully lit.
double lambert_sphere(double phase_rad) {
    return 2.0 / 3 * (std::sin(phase_rad) + (kPi - phase_rad) * std::cos(phase_rad)) / kPi;
}

}  // namespace

double lit_share(double phase_rad) { return 0.5 * (1 + std::cos(phase_rad)); }

ExpectedSignal read_out(const CameraSheet& camera, double signal_e) {
    const double charge_e = signal_e + camera.dark_e_s * camera.exposure_s;
    const double held_e = std::min(signal_e, camera.full_scale_e);
    ExpectedSignal out;
    out.signal_e = signal_e;
    out.full_scale = charge_e / camera.full_scale_e;
    out.dn =
        std::min(camera.camera.offset_dn + camera.camera.read_e(charge_e) * camera.gain_dn_e, camera.max_dn);
    out.snr = held_e / std::sqrt(held_e + camera.dark_total_e * camera.dark_total_e);
    return out;
}

ExpectedSignal expected_signal(const CameraSheet& camera, const LitObject& object) {
    // The first scene of the sheet is white, at 1 au, and faces the Sun.
    const double white_e = camera.scenes.front().signal_e;
    const double lit = lit_share(object.phase_rad);
    if (!(lit > 1e-6) && !(object.emitted_e > 0)) return {};
    const double disk_e = object.reflectance * white_e / (object.sun_au * object.sun_au) * object.sunlit *
                          lambert_sphere(object.phase_rad);
    if (object.emitted_e > 0) {
        const double all_e = disk_e + object.emitted_e;
        return read_out(camera,
                        object.area_px < kPoint_px ? all_e * object.area_px * camera.peak_share : all_e);
    }
    const double lit_px = lit * object.area_px;
    return read_out(camera, lit_px < kPoint_px ? disk_e * object.area_px * camera.peak_share : disk_e / lit);
}

}  // namespace hilcam
