#include "emulator/check/camera_sheet.h"

#include <algorithm>
#include <cmath>

#include "emulator/loop/shutter_timing.h"
#include "render/sky/star_spectra.h"
#include "render/sky/sun.h"
#include "render/vocabulary/units.h"
#include "sensor/chain.h"
#include "sensor/mtf.h"
#include "sensor/optics.h"
#include "sensor/optics_otf.h"

namespace hilcam {
namespace {

double sum_of(const Spectrum& a, const Spectrum& b) {
    double sum = 0;
    for (int i = 0; i < kMaxBins; ++i) sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
    return sum;
}

// Returns the largest number of bins over a range, one edge of which is where thermal bins begin if that is
// within it.
SpectralGrid even_grid(double from_um, double to_um) {
    std::vector<double> edges_um;
    for (int i = 0; i <= kMaxBins; ++i) edges_um.push_back(from_um + (to_um - from_um) * i / kMaxBins);
    if (from_um < kThermalFrom_um && to_um > kThermalFrom_um)
        *std::min_element(edges_um.begin() + 1, edges_um.end() - 1, [](double a, double b) {
            return std::abs(a - kThermalFrom_um) < std::abs(b - kThermalFrom_um);
        }) = kThermalFrom_um;
    return SpectralGrid(edges_um);
}

// Returns the grid that all of the camera's curves cover; constants cover silicon's range.
SpectralGrid own_grid(const CameraModel& c) {
    double from_um = 0.40, to_um = 0.95;
    bool any = false;
    const auto cover = [&](const Curve& curve) {
        if (curve.wavelength_um.size() < 2) return;
        from_um = any ? std::max(from_um, curve.wavelength_um.front()) : curve.wavelength_um.front();
        to_um = any ? std::min(to_um, curve.wavelength_um.back()) : curve.wavelength_um.back();
        any = true;
    };
    cover(c.quantum_efficiency);
    cover(c.transmission);
    for (const ColorFilterConfig& filter : c.color_filter.filters) cover(filter.transmission);
    from_um = std::clamp(from_um, 0.28, kLongest_um - 0.01);
    to_um = std::clamp(to_um, from_um + 0.01, kLongest_um);
    return even_grid(from_um, to_um);
}

void set_geometry(const CameraModel& c, CameraSheet& s) {
    const ImageGeometry g = geometry_of(c, 0);
    const double w = g.width_px, h = g.height_px;
    const auto at = [&](double x, double y) { return g.direction_camera(x, y); };
    const bool line = c.shutter.kind == ShutterKind::kLineScan;
    s.ifov_rad = c.pitch_m / c.focal_length_m;
    s.field_x_rad = angle_between_rad(at(0, g.center_px().y), at(w, g.center_px().y));
    s.field_y_rad = line ? s.ifov_rad : angle_between_rad(at(g.center_px().x, 0), at(g.center_px().x, h));
    s.field_diagonal_rad = line ? s.field_x_rad : angle_between_rad(at(0, 0), at(w, h));
    s.frame_px = frame_size(c);
    s.frame_bytes =
        static_cast<double>(s.frame_px[0]) * s.frame_px[1] * static_cast<double>(c.container_bits) / 8;
}

constexpr int kSide_px = 64;

// Returns the camera at the centre of its field, with all pixels alike.
CameraModel middle_of(const CameraModel& camera) {
    CameraModel c = camera;
    c.dark_current_e_s = 0;
    c.prnu_fraction = 0;
    c.fixed_pattern = {};
    c.defects = {};
    c.cosmic_rays = {};
    c.black_rows = c.black_columns = 0;
    c.binning_x = c.binning_y = 1;
    c.width_px = c.height_px = kSide_px;
    c.window_px.clear();
    c.principal_point_px.clear();
    return c;
}

// Computes the shares of the central pixel and of 3 x 3 pixels in a point's electrons, with the camera's own
// chain.
void set_point_shares(const CameraModel& camera, const SpectralGrid& grid, CameraSheet& s) {
    CameraModel c = middle_of(camera);
    c.color_filter = {};
    SensorChain chain(c, grid, {0, 1, 1});
    PointSource star;
    star.position_px = {kSide_px / 2 + 0.5f, kSide_px / 2 + 0.5f};
    const Spectrum per_irradiance = electrons_per_s_per_irradiance(c, grid);
    constexpr float kElectrons = 1e6f;  // so many that what the PSF leaves out does not matter
    float response = 0;
    for (int b = 0; b < grid.size(); ++b) response += per_irradiance[b];
    for (int b = 0; b < grid.size(); ++b) star.irradiance_w_m2_um[b] = kElectrons / response;
    RadianceImage dark(kSide_px, kSide_px, grid.size());
    ElectronImage electrons(kSide_px, kSide_px);
    chain.expose(dark, std::span(&star, 1), {1, 0, {}, {}}, electrons);
    s.core_share = s.peak_share = 0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            const double share = static_cast<double>(electrons.row(
                                     kSide_px / 2 + y)[static_cast<std::size_t>(kSide_px / 2 + x)]) /
                                 static_cast<double>(kElectrons);
            s.core_share += share;
            if (x == 0 && y == 0) s.peak_share = share;
        }
}

void set_lens(const CameraModel& c, const SpectralGrid& grid, const Spectrum& response, CameraSheet& s) {
    s.transmission = lens_transmission(c, s.mean_um);
    s.t_number = c.f_number / std::sqrt(s.transmission);
    s.airy_radius_px = 1.22 * s.mean_um * 1e-6 * c.f_number / c.pitch_m;
    const OpticsOtf optics(c, grid, response, {c.defocus_m, c.wavefront_rms_m});
    s.mtf_optics_x = std::abs(optics.at(0.5, 0));
    s.mtf_optics_y = std::abs(optics.at(0, 0.5));
    s.mtf_pixel_x = std::abs(sinc(0.5 * c.pixel_aperture_x_m() / c.pitch_m));
    s.mtf_pixel_y = std::abs(sinc(0.5 * c.pixel_aperture_y_m() / c.pitch_m));
    const SensorChain chain(middle_of(c), grid, {0, 1, 1});
    s.mtf_system_x = chain.mtf(0.5, 0);
    s.mtf_system_y = chain.mtf(0, 0.5);
}

void set_noise(const CameraModel& c, CameraSheet& s) {
    s.gain_dn_e = c.system_gain_dn_e(c.gain_db);
    s.max_dn = std::exp2(static_cast<double>(c.bits)) - 1;
    s.well_e = c.full_well_e;
    s.well_dn = c.offset_dn + c.read_e(c.full_well_e) * s.gain_dn_e;
    s.converter_e = c.charge_of_read_e((s.max_dn - c.offset_dn) / s.gain_dn_e);
    s.full_scale_e = std::min(s.well_e, s.converter_e);
    s.dark_e_s = c.dark_current_now_e_s();
    s.dark_shot_e = std::sqrt(s.dark_e_s * s.exposure_s);
    s.quantisation_e = std::sqrt(1.0 / 12) / s.gain_dn_e;
    s.shot_half_well_e = std::sqrt(0.5 * c.full_well_e);
    s.prnu_half_well_e = c.prnu_fraction * 0.5 * c.full_well_e;
    s.dark_total_e = std::hypot(s.dark_shot_e, c.dark_noise_e(), s.quantisation_e);
    s.dynamic_range = s.full_scale_e / s.dark_total_e;
}

double snr_of(const CameraSheet& s, double signal_e) {
    const double n = std::min(signal_e, s.full_scale_e);
    return n / std::sqrt(n + s.dark_total_e * s.dark_total_e);
}

void set_scenes(const SpectralGrid& grid, const Spectrum& response, CameraSheet& s) {
    const Spectrum sun = solar_irradiance_1au_w_m2_um(grid);
    const double per_albedo_e = sum_of(response, sun) / kPi * s.exposure_s;
    const auto add = [&](const char* name, double albedo) {
        s.scenes.push_back({name, albedo * per_albedo_e, snr_of(s, albedo * per_albedo_e)});
    };
    add("white Lambert surface facing the Sun", 1);
    // Geometric albedo of the full Moon: Lane & Irvine, Astronomical Journal 78, 267 (1973), 0.113 in V;
    // NASA's fact sheet has 0.12.
    add("full Moon (regolith, geometric albedo 0.12)", 0.12);
    add("Earth (albedo 0.3), Sun overhead", 0.3);
}

// The temperature difference that changes a pixel by its temporal noise.
void set_thermal(const SpectralGrid& grid, const Spectrum& response, CameraSheet& s) {
    if (!grid.has_thermal()) return;
    const auto electrons = [&](double kelvin) {
        return s.exposure_s * sum_of(response, planck_w_m2_sr_um(grid, kelvin));
    };
    s.black_body_e = electrons(kRoomTemperature_k);
    const double held_e = std::min(s.black_body_e, s.full_scale_e);
    const double per_k = 0.5 * (electrons(kRoomTemperature_k + 1) - electrons(kRoomTemperature_k - 1));
    s.netd_k = std::sqrt(held_e + s.dark_total_e * s.dark_total_e) / per_k;
}

void set_stars(const CameraModel& c, const SpectralGrid& grid, const Curve* filter, CameraSheet& s) {
    const Spectrum per_irradiance = electrons_per_s_per_irradiance(c, grid, filter);
    const StarSpectra spectra(grid);
    const auto electrons = [&](double magnitude) {
        return s.exposure_s * sum_of(per_irradiance, spectra.irradiance_w_m2_um(magnitude, {}));
    };
    for (const double magnitude : {0.0, 5.0}) {
        const double total_e = electrons(magnitude), peak_e = total_e * s.peak_share;
        s.stars.push_back({magnitude, total_e, peak_e, snr_of(s, peak_e)});
    }
    const double background_e2 = 9 * s.dark_total_e * s.dark_total_e;
    const double min_e = 0.5 * (25 + std::sqrt(625 + 100 * background_e2));
    s.faintest_magnitude = 2.5 * std::log10(electrons(0) * s.core_share / min_e);
}

}  // namespace

CameraSheet camera_sheet(const CameraModel& c) {
    const SpectralGrid grid = own_grid(c);
    const Spectrum sun = solar_irradiance_1au_w_m2_um(grid);
    const Curve* filter = nullptr;
    CameraSheet s;
    for (const ColorFilterConfig& candidate : c.color_filter.filters)
        if (!filter || sum_of(electrons_per_s_per_radiance(c, grid, &candidate.transmission), sun) >
                           sum_of(electrons_per_s_per_radiance(c, grid, filter), sun)) {
            filter = &candidate.transmission;
            s.filter = candidate.name;
        }
    const Spectrum response = electrons_per_s_per_radiance(c, grid, filter);
    s.camera = c;
    s.from_um = grid.from_um(0);
    s.to_um = grid.to_um(grid.size() - 1);
    for (int b = 0; b < grid.size(); ++b) {
        s.response_e_s += static_cast<double>(response[b]);
        s.mean_um += grid.center_um(b) * static_cast<double>(response[b]) * static_cast<double>(sun[b]);
    }
    s.mean_um /= sum_of(response, sun);
    s.exposure_s = ShutterTiming(c).exposure_s(c.exposure_s);
    set_geometry(c, s);
    set_lens(c, grid, response, s);
    set_noise(c, s);
    set_point_shares(c, grid, s);
    s.saturation_w_m2_sr_um = (s.full_scale_e - s.dark_e_s * s.exposure_s) / (s.response_e_s * s.exposure_s);
    set_scenes(grid, response, s);
    set_thermal(grid, response, s);
    set_stars(c, grid, filter, s);
    return s;
}

double emitted_e(const CameraSheet& sheet, const SpectralGrid& grid, const Spectrum& radiance_w_m2_sr_um) {
    return sheet.exposure_s * sum_of(electrons_per_s_per_radiance(sheet.camera, grid), radiance_w_m2_sr_um);
}

double share_in_bins(const CameraModel& c, const SpectralGrid& bins) {
    const auto sunlight = [&](const SpectralGrid& grid) {
        return sum_of(electrons_per_s_per_radiance(c, grid), solar_irradiance_1au_w_m2_um(grid));
    };
    const SpectralGrid own = own_grid(c);
    const double from_um = std::max(own.from_um(0), bins.from_um(0));
    const double to_um = std::min(own.to_um(own.size() - 1), bins.to_um(bins.size() - 1));
    if (to_um <= from_um) return 0;
    return sunlight(even_grid(from_um, to_um)) / sunlight(own);
}

}  // namespace hilcam
