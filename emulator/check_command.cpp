#include "emulator/check_command.h"

#include <spdlog/fmt/fmt.h>

#include "emulator/emulator.h"
#include "emulator/scene_loader.h"
#include "render/sun.h"
#include "render/units.h"
#include "sensor/chain.h"
#include "sensor/optics.h"

namespace hilcam {
namespace {

std::string camera_sheet(const ScenarioConfig& s, const SpectralGrid& grid) {
    const CameraModel& c = s.camera;
    const double pixel_rad = c.pitch_m / c.focal_length_m;
    const auto field_deg = [&](std::int64_t px) {
        return 2 * std::atan(0.5 * static_cast<double>(px) * pixel_rad) / kDegree_rad;
    };
    const Spectrum per_radiance = electrons_per_s_per_radiance(c, grid);
    const Spectrum sun = solar_irradiance_1au_w_m2_um(grid);
    double white_e_s = 0;  // a white Lambert surface in full Sun at 1 au
    for (int b = 0; b < grid.size(); ++b)
        white_e_s += static_cast<double>(per_radiance[b]) * static_cast<double>(sun[b]) / kPi;
    const SensorChain chain(c, grid, {28, 1, 1});
    std::string out = fmt::format("camera {}\n", c.name);
    out += fmt::format(
        "  field {:.3f} x {:.3f} deg, IFOV {:.2f} arcsec, {} x {} px of {:.2f} um, f = {:.1f} mm, f/{:.1f}\n",
        field_deg(c.width_px), field_deg(c.height_px), pixel_rad / kArcsecond_rad, c.width_px, c.height_px,
        c.pitch_m * 1e6, c.focal_length_m * 1e3, c.f_number);
    out += fmt::format("  MTF at Nyquist {:.3f} (optics and pixel aperture)\n", chain.mtf_at_nyquist());
    out += fmt::format(
        "  full well {:.0f} e-, read noise {:.1f} e-, dark current {:.2f} e-/s, {:.4f} DN/e-, {} bits\n",
        c.full_well_e, c.read_noise_e, c.dark_current_e_s, c.system_gain_dn_e(0), c.bits);
    out += fmt::format(
        "  a white surface in full Sun gives {:.3g} e-/s; it fills the well in {:.3f} ms; now {:.3f} ms\n",
        white_e_s, 1e3 * c.full_well_e / white_e_s, 1e3 * c.exposure_s);
    const double signal = std::min(c.full_well_e, white_e_s * c.exposure_s);
    out += fmt::format(
        "  its SNR at that exposure {:.1f}\n",
        signal / std::sqrt(signal + c.dark_current_e_s * c.exposure_s + c.read_noise_e * c.read_noise_e));
    return out;
}

}  // namespace

std::string check_scenario(const ScenarioConfig& s) {
    const SpectralGrid grid(s.spectrum_edges_um);
    const TimeTai time = parse_utc(s.time_utc);
    const ImageGeometry geometry =
        geometry_of(s.camera, static_cast<int>(s.quality.guard_px), static_cast<int>(s.quality.oversampling));
    const std::unique_ptr<Renderer> renderer = load_renderer(s, grid, geometry);
    const WorldSnapshot world = snapshot_at(s, time, time);
    renderer->require_air(world);
    std::string out =
        fmt::format("scenario {} at {}\n", s.name, format_utc(time)) + camera_sheet(s, grid) + "plan\n";
    for (const std::string& line : renderer->explain_plan(world)) out += "  " + line + "\n";
    return out;
}

}  // namespace hilcam
