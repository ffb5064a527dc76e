#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "emulator/check/camera_sheet.h"
#include "emulator/loop/shutter_timing.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

template <class... A>
void line(std::string& out, const char* name, fmt::format_string<A...> format, A&&... values) {
    out += fmt::format("  {:<15} {}\n", name, fmt::format(format, std::forward<A>(values)...));
}

void add_geometry(const CameraSheet& s, std::string& out) {
    const CameraModel& c = s.camera;
    line(out, "sensor", "{} x {} px of {:.2f} um, {:.2f} x {:.2f} mm", c.width_px, c.height_px,
         c.pitch_m * 1e6, static_cast<double>(c.width_px) * c.pitch_m * 1e3,
         static_cast<double>(c.height_px) * c.pitch_m * 1e3);
    line(out, "field", "{:.3f} x {:.3f} deg, diagonal {:.3f} deg", s.field_x_rad / kDegree_rad,
         s.field_y_rad / kDegree_rad, s.field_diagonal_rad / kDegree_rad);
    line(out, "IFOV", "{:.3f} arcsec, {:.2f} urad", s.ifov_rad / kArcsecond_rad, s.ifov_rad * 1e6);
    const PixelRectangle window = window_of(c);
    line(out, "frame",
         "{} x {} px: window {} x {} at ({}, {}), {} black rows, {} black columns, binned {} x {}",
         s.frame_px[0], s.frame_px[1], window.width, window.height, window.left, window.top, c.black_rows,
         c.black_columns, c.binning_x, c.binning_y);
    line(out, "", "{} bits in {}, {:.3g} MB", c.frame_bits(), c.container_bits, s.frame_bytes * 1e-6);
}

void add_lens(const CameraSheet& s, std::string& out) {
    const CameraModel& c = s.camera;
    line(out, "lens", "f = {:.2f} mm, f/{:.2f}, T/{:.2f}, aperture {:.2f} mm, obscuration {:.2f}",
         c.focal_length_m * 1e3, c.f_number, s.t_number, c.aperture_diameter_m() * 1e3,
         c.central_obscuration_ratio);
    line(out, "band", "{:.2f} to {:.2f} um, photo-electrons of sunlight at {:.3f} um on average{}", s.from_um,
         s.to_um, s.mean_um, s.filter.empty() ? "" : ", filter " + s.filter);
    line(out, "Airy radius", "{:.2f} px ({:.2f} um, 1.22 lambda N at that wavelength)", s.airy_radius_px,
         s.airy_radius_px * c.pitch_m * 1e6);
    line(out, "MTF at Nyquist", "along rows {:.3f}, along columns {:.3f} ({:.1f} cycles/mm)", s.mtf_system_x,
         s.mtf_system_y, 0.5e-3 / c.pitch_m);
    line(out, "", "of it optics {:.3f}, {:.3f}; pixel {:.3f}, {:.3f}; the rest {:.3f}, {:.3f}",
         s.mtf_optics_x, s.mtf_optics_y, s.mtf_pixel_x, s.mtf_pixel_y,
         s.mtf_system_x / (s.mtf_optics_x * s.mtf_pixel_x),
         s.mtf_system_y / (s.mtf_optics_y * s.mtf_pixel_y));
}

void add_shutter(const CameraSheet& s, std::string& out) {
    const CameraModel& c = s.camera;
    const ShutterTiming timing(c);
    const double rows = window_of(c).height, line_s = c.shutter.line_time_s;
    const double period_s = timing.period_s(c.frame_rate_hz, s.exposure_s);
    line(out, "exposure", "{:.4g} ms, gain {:.1f} dB, {:.4g} frames/s", s.exposure_s * 1e3, c.gain_db,
         1 / period_s);
    switch (c.shutter.kind) {
        case ShutterKind::kGlobal:
            return line(out, "shutter", "global");
        case ShutterKind::kRolling:
            return line(out, "shutter", "rolling, {:.3f} us per row, {:.3f} ms from the first to the last",
                        line_s * 1e6, (rows - 1) * line_s * 1e3);
        case ShutterKind::kFrameTransfer:
            return line(out, "shutter",
                        "frame transfer, {:.3f} us per row: {:.3g} of the light smears over a column",
                        line_s * 1e6, rows * line_s / s.exposure_s);
        case ShutterKind::kLineScan:
            break;
    }
    line(out, "shutter", "line scan, {:.1f} lines/s, {} stages, {} clock phases, {:.3f} s per frame",
         1 / line_s, c.shutter.tdi_stages, c.shutter.tdi_phases, rows * line_s);
    line(out, "", "square pixels at {:.4f} deg/s, which is {:.4g} m/s over ground at 1 km",
         s.ifov_rad / line_s / kDegree_rad, 1e3 * s.ifov_rad / line_s);
}

void add_radiometry(const CameraSheet& s, std::string& out) {
    const CameraModel& c = s.camera;
    line(out, "response", "{:.4g} e-/s per W m^-2 sr^-1 um^-1", s.response_e_s);
    line(out, "saturation", "{:.4g} W m^-2 sr^-1 um^-1 (grey, at this exposure), {:.4g} e-",
         s.saturation_w_m2_sr_um, s.full_scale_e);
    line(out, "", "full well {:.4g} e- is {:.1f} DN, the converter ends at {:.0f} DN or {:.4g} e-: {} first",
         s.well_e, s.well_dn, s.max_dn, s.converter_e,
         s.well_e <= s.converter_e ? "the well saturates" : "the converter saturates");
    line(out, "gain", "{:.4g} DN/e- ({:.4g} e-/DN), black at {:.1f} DN{}", s.gain_dn_e, 1 / s.gain_dn_e,
         c.offset_dn,
         c.converter.companding == Companding::kNone ? "" : "; DN are the converter's, before companding");
    for (const CameraSheet::Scene& scene : s.scenes)
        line(out, &scene == &s.scenes.front() ? "SNR" : "", "{:.1f} ({:.1f} dB) {}: {:.4g} e-{}", scene.snr,
             20 * std::log10(scene.snr), scene.name, scene.signal_e,
             scene.signal_e > s.full_scale_e ? ", saturated" : "");
    if (s.netd_k > 0)
        line(out, "thermal",
             "black body of {:.0f} K: {:.4g} e-{}; NETD {:.1f} mK (one pixel, temporal noise)",
             kRoomTemperature_k, s.black_body_e, s.black_body_e > s.full_scale_e ? ", saturated" : "",
             1e3 * s.netd_k);
    for (const CameraSheet::Star& star : s.stars)
        line(out, &star == &s.stars.front() ? "stars" : "",
             "V = {:.0f} (B-V = 0): {:.4g} e-, {:.4g} e- in the pixel that it is centred on, SNR {:.2f}{}",
             star.magnitude, star.total_e, star.peak_e, star.snr,
             star.peak_e > s.full_scale_e ? ", saturated" : "");
    line(out, "", "middle pixel {:.1f} %, 3 x 3 pixels {:.1f} % of the light; SNR 5 in 3 x 3 at V = {:.2f}",
         100 * s.peak_share, 100 * s.core_share, s.faintest_magnitude);
}

void add_noise(const CameraSheet& s, std::string& out) {
    const CameraModel& c = s.camera;
    line(out, "dark current", "{:.4g} e-/s at {:.1f} C ({:.4g} at {:.1f} C, twice every {:.1f} K)",
         s.dark_e_s, c.temperature_c, c.dark_current_e_s, c.dark_reference_c, c.dark_doubling_k);
    const auto noise = [&](const char* name, double value_e, const char* what) {
        line(out, name, "{:9.3f} e-  {:8.3f} DN  {}", value_e, value_e * s.gain_dn_e, what);
    };
    noise("noise", s.shot_half_well_e, "shot noise at half the full well");
    noise("", s.dark_shot_e, "shot noise of the dark current");
    noise("", c.read_noise_e, "read");
    if (c.reset_noise_e > 0) noise("", c.reset_noise_e, "reset");
    if (c.row_noise_e > 0) noise("", c.row_noise_e, "of rows");
    if (c.flicker_noise_e > 0) noise("", c.flicker_noise_e, "1/f");
    noise("", s.quantisation_e, "quantisation, 1 / (sqrt 12 K)");
    noise("", s.dark_total_e, "all of them in the dark");
    noise("", s.prnu_half_well_e, "PRNU at half the full well (fixed)");
    noise("", c.dsnu_e, "DSNU (fixed)");
    line(out, "dynamic range", "{:.1f} dB, {:.2f} bits", 20 * std::log10(s.dynamic_range),
         std::log2(s.dynamic_range));
}

}  // namespace

std::string to_text(const CameraSheet& s) {
    std::string out =
        fmt::format("camera {}\n", s.camera.name.empty() ? "without a name" : harmless(s.camera.name));
    add_geometry(s, out);
    add_lens(s, out);
    add_shutter(s, out);
    add_radiometry(s, out);
    add_noise(s, out);
    return out;
}

}  // namespace hilcam
