#include "emulator/check_command.h"

#include <spdlog/fmt/fmt.h>

#include "emulator/emulator.h"
#include "emulator/scene_loader.h"
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
    const SensorChain chain(c, grid, 28, 1);
    std::string out = fmt::format("camera {}\n", c.name);
    out += fmt::format(
        "  field {:.3f} x {:.3f} deg, IFOV {:.2f} arcsec, {} x {} px of {:.2f} um, f = {:.1f} mm, f/{:.1f}\n",
        field_deg(c.width_px), field_deg(c.height_px), pixel_rad / kArcsecond_rad, c.width_px, c.height_px,
        c.pitch_m * 1e6, c.focal_length_m * 1e3, c.f_number);
    out += fmt::format("  MTF at Nyquist {:.3f} (optics and pixel aperture)\n", chain.mtf_at_nyquist());
    out += fmt::format(
        "  full well {:.0f} e-, read noise {:.1f} e-, dark current {:.2f} e-/s, {:.4f} DN/e-, {} bits\n",
        c.full_well_e, c.read_noise_e, c.dark_current_e_s, c.gain_dn_e, c.bits);
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
    const std::vector<Motion> motions = initial_motions(s, time);
    const Scene scene = load_scene(s, grid);
    const Bodies bodies = bodies_at(time, s.origin);

    std::string out = fmt::format("scenario {} at {}\n", s.name, format_utc(time)) + camera_sheet(s, grid);
    out += fmt::format("plan\n  {} spectral bins from {:.2f} to {:.2f} um\n", grid.size(), grid.from_um(0),
                       grid.to_um(grid.size() - 1));
    const Vec3d camera_m = motions[0].pose.position_world_m;
    const Mat3d camera_from_world = transposed(to_matrix(motions[0].pose.world_from_body));
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Vec3d offset_m = motions[i + 1].pose.position_world_m - camera_m;
        out += fmt::format("  object {} '{}': {} triangles, {} surfaces, {:.3f} m away, {}\n", i + 1,
                           scene.objects[i].name, scene.objects[i].mesh.triangles.size(),
                           scene.objects[i].mesh.surfaces.size(), length(offset_m),
                           (camera_from_world * offset_m).z > 0 ? "before the camera" : "behind the camera");
    }
    const RenderQuality& q = s.quality.render;
    out += fmt::format(
        "  {} x {} rays per pixel where an object can be; paths of up to {} surfaces, dropped below {:g}\n",
        q.samples_per_axis, q.samples_per_axis, q.max_depth, q.contribution_threshold);
    const Vec3d sun = normalized(bodies.sun_world_m - camera_m);
    out += fmt::format("  Sun at [{:.4f}, {:.4f}, {:.4f}] (ICRF), {:.4f} au\n", sun.x, sun.y, sun.z,
                       length(bodies.sun_world_m - camera_m) / kAstronomicalUnit_m);
    const double earth_m = length(bodies.earth_world_m - camera_m);
    out +=
        s.earth.visible
            ? fmt::format(
                  "  Earth's centre {:.0f} km away, {:.2f} deg wide: drawn, reflected and lighting objects\n",
                  earth_m * 1e-3,
                  2 * std::asin(std::min(1.0, kEarthEquatorialRadius_m / earth_m)) / kDegree_rad)
            : std::string("  Earth: not visible by the scenario\n");
    out += fmt::format("  {} stars to V {:.1f}\n", scene.stars.size(), s.stars.faintest_magnitude);
    out += "  atmosphere: none\n";
    return out;
}

}  // namespace hilcam
