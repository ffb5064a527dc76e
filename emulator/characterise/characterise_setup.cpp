#include "emulator/characterise/characterise_setup.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "render/vocabulary/units.h"
#include "sensor/optics.h"

namespace hilcam {
namespace {

constexpr int kFlatWindow_px = 512;
// A line camera has one row of pixels: few columns would determine its fixed pattern badly, and lines are
// cheap.
constexpr int kLineWidth_px = 8192, kLines = 64;
// Pixels after which a filter along the row, or imperfect charge transfer, has settled.
constexpr int kWindowMargin_px = 8;
// Smallest noise of a dark pixel [DN] at which rounding adds 1/12 DN^2 to its variance. The error is of the
// order exp(-2 pi^2 sigma^2) (Widrow, Kollar & Liu, IEEE Trans. Instrum. Meas. 45, 1996), here 6e-5.
constexpr double kMinDarkNoise_dn = 0.7;
// Dark signal at the longest exposure as a share of saturation; the response is still straight there.
constexpr double kMaxDark_fraction = 0.1;
constexpr double kLine_um = 0.001;  // width of the lamp's line

bool line_scan(const CameraModel& c) { return c.shutter.kind == ShutterKind::kLineScan; }

const Curve* filter_curve(const CameraModel& c, char letter) {
    for (const ColorFilterConfig& f : c.color_filter.filters)
        if (letter != 0 && f.name == std::string(1, letter)) return &f.transmission;
    return nullptr;
}

// Returns the wavelength of the greatest quantum efficiency among those that the lens passes.
double best_wavelength_um(const CameraModel& c, char letter) {
    const Curve* filter = filter_curve(c, letter);
    std::vector<double> candidates = c.quantum_efficiency.wavelength_um;
    for (const Curve* curve : {filter, static_cast<const Curve*>(&c.transmission)})
        if (curve)
            candidates.insert(candidates.end(), curve->wavelength_um.begin(), curve->wavelength_um.end());
    // Constant curves have one point, which does not limit the others' range.
    double max_transmission = 0;
    for (const double um : candidates)
        max_transmission = std::max(max_transmission, lens_transmission(c, um));
    double best_um = 0, best = -1;
    for (const double um : candidates) {
        if (um < 0.21 || um > 2.49 || lens_transmission(c, um) < 0.1 * max_transmission) continue;
        const double efficiency = c.quantum_efficiency.at(um) * (filter ? filter->at(um) : 1);
        if (efficiency > best) best = efficiency, best_um = um;
    }
    return best_um;
}

// Returns a window about the boresight, or as close to it as the sensor allows.
std::vector<double> central_window(const CameraModel& c, int width, int height) {
    const PixelRectangle given = window_of(c);
    const bool has_center = c.principal_point_px.size() == 2;
    const double x = has_center ? c.principal_point_px[0] : 0.5 * static_cast<double>(c.width_px);
    const double y = has_center ? c.principal_point_px[1] : 0.5 * static_cast<double>(c.height_px);
    width = std::min(width, given.width), height = std::min(height, given.height);
    const auto start = [](double center, int size, int first, int room) {
        return std::clamp(std::floor(center - 0.5 * size), 1.0 * first, 1.0 * (first + room - size));
    };
    return {start(x, width, given.left, given.width), start(y, height, given.top, given.height), 1.0 * width,
            1.0 * height};
}

void set_window(LabSetup& s) {
    CameraModel& c = s.camera;
    const bool lines = line_scan(c);
    require_lines(c, kLines);
    c.window_px =
        lines ? central_window(c, kLineWidth_px, kLines) : central_window(c, kFlatWindow_px, kFlatWindow_px);
    s.remarks.push_back(fmt::format("window {} x {} px about the boresight", c.window_px[2], c.window_px[3]));
}

std::vector<std::string> pattern_rows(const std::string& pattern) {
    std::vector<std::string> rows(1);
    for (const char letter : pattern)
        if (letter == ' ')
            rows.emplace_back();
        else
            rows.back() += letter;
    return rows;
}

char letter_at(const std::vector<std::string>& rows, int x, int y) {
    const std::string& row = rows[static_cast<std::size_t>(y) % rows.size()];
    return row[static_cast<std::size_t>(x) % row.size()];
}

double peak_transmission(const CameraModel& c, char letter) {
    const Curve* const filter = filter_curve(c, letter);
    return filter ? *std::max_element(filter->value.begin(), filter->value.end()) : 1;
}

// Returns the most frequent filter in the window, among those that pass at least half as much light as the
// clearest one, because masks between strips of filters pass none. 0: the camera has no filters.
char most_frequent_filter(const CameraModel& c) {
    if (c.color_filter.pattern.empty()) return 0;
    const std::vector<std::string> rows = pattern_rows(c.color_filter.pattern);
    const PixelRectangle w = window_of(c);
    std::map<char, int> count;
    for (int y = w.top; y < w.top + w.height; ++y)
        for (int x = w.left; x < w.left + w.width; ++x) ++count[letter_at(rows, x, y)];
    double clearest = 0;
    for (const auto& [letter, n] : count) clearest = std::max(clearest, peak_transmission(c, letter));
    char most = 0;
    for (const auto& [letter, n] : count)
        if (peak_transmission(c, letter) >= 0.5 * clearest && (most == 0 || n > count[most])) most = letter;
    return most;
}

void switch_off(LabSetup& s) {
    CameraModel& c = s.camera;
    const auto set = [&](bool on, const char* remark) {
        if (on) s.remarks.emplace_back(remark);
    };
    set(c.binning_x * c.binning_y > 1,
        "pixels are read one by one: figures are those of a pixel, not of a bin");
    c.binning_x = c.binning_y = 1;
    set(c.converter.companding != Companding::kNone,
        "numbers are taken before companding: it would be undone first, and its steps are no noise of the "
        "camera");
    c.converter.companding = Companding::kNone;
    set(c.jitter.rms_rad[0] > 0 || c.jitter.rms_rad[1] > 0 || !c.jitter.psd_arcsec2_hz.empty(),
        "the camera stands still: jitter is the spacecraft's");
    c.jitter = {};
    set(c.cosmic_rays.rate_cm2_s > 0, "no cosmic rays: they are the orbit's");
    c.cosmic_rays.rate_cm2_s = 0;
    set(c.filters.high_pass_cy_px > 0,
        "the high-pass filter is bypassed: behind it no even light keeps its level along a row");
    c.filters.high_pass_cy_px = 0;
    const bool filters = c.filters.low_pass_cy_px > 0 || c.filters.boost > 0;
    set(filters && !c.color_filter.pattern.empty(),
        "the filters along the rows are bypassed: behind them a pixel has its neighbours' colours");
    if (!c.color_filter.pattern.empty()) c.filters = {};
    c.auto_exposure.on = false;
    c.sequence.clear();
}

// Raises the black level so that the lower half of the noise is not cut off (section 6.5).
void set_black_level(LabSetup& s) {
    CameraModel& c = s.camera;
    const double gain = std::max(c.system_gain_dn_e(s.gain_db), c.system_gain_dn_e(s.dark_gain_db));
    const double spread_e =
        std::sqrt(std::pow(c.dark_noise_e(), 2) + std::pow(c.dsnu_e, 2) + std::pow(c.fixed_pattern.row_e, 2) +
                  std::pow(c.fixed_pattern.column_e, 2));
    const double least = std::ceil(6 * spread_e * gain + 2);
    if (c.offset_dn >= least) return;
    s.remarks.push_back(fmt::format("black level raised from {:g} to {:g} DN: nothing is cut off in the dark",
                                    c.offset_dn, least));
    c.offset_dn = least;
}

void choose_gains(LabSetup& s) {
    const CameraModel& c = s.camera;
    s.gain_db = std::clamp(0.0, c.gain_range_db[0], c.gain_range_db[1]);
    const double noise_dn = c.dark_noise_e() * c.system_gain_dn_e(s.gain_db);
    s.dark_gain_db = s.gain_db;
    if (noise_dn <= 0 || noise_dn >= kMinDarkNoise_dn) return;
    s.dark_gain_db =
        std::min(s.gain_db + std::ceil(20 * std::log10(kMinDarkNoise_dn / noise_dn)), c.gain_range_db[1]);
    if (s.dark_gain_db > s.gain_db)
        s.remarks.push_back(fmt::format(
            "in the dark at {:g} dB: at {:g} dB the noise of {:.2f} DN would not cross the converter's steps",
            s.dark_gain_db, s.gain_db, noise_dn));
}

void choose_exposures(LabSetup& s) {
    const CameraModel& c = s.camera;
    const double dark_e_s = c.dark_current_now_e_s();
    const double max_dark_e = kMaxDark_fraction * configured_saturation_e(c, s.dark_gain_db);
    double min_s = c.exposure_range_s[0], max_s = c.exposure_range_s[1];
    if (line_scan(c)) min_s = max_s = static_cast<double>(c.shutter.tdi_stages) * c.shutter.line_time_s;
    const bool fixed = max_s < 2 * min_s;
    if (fixed)
        s.remarks.push_back(
            "one exposure time: levels by light; dark current with the camera's clock slowed down");
    s.shortest_s = min_s;
    s.longest_s = fixed ? 1e4 * min_s : max_s;
    if (dark_e_s > 0) s.longest_s = std::clamp(max_dark_e / dark_e_s, s.shortest_s, s.longest_s);
    // Levels go down to 1/25 of the longest exposure. Then dark current stays negligible, and the rows of a
    // frame-transfer CCD pass the light in a small part of the exposure.
    s.by_light = max_s < 50 * min_s;
    double top_s = std::clamp(c.exposure_s, 30 * min_s, std::max(30 * min_s, max_s));
    if (c.shutter.kind == ShutterKind::kFrameTransfer)
        top_s = std::max(top_s, 20 * c.window_px[3] * c.shutter.line_time_s);
    if (dark_e_s > 0) top_s = std::min(top_s, std::max(30 * min_s, max_dark_e / dark_e_s));
    s.exposure_s = s.by_light ? std::clamp(c.exposure_s, min_s, max_s) : std::min(top_s, max_s);
}

}  // namespace

void require_lines(CameraModel& c, int lines) {
    const FixedPatternConfig& f = c.fixed_pattern;
    if (!line_scan(c) || !f.prnu_map.empty() || !f.offset_map.empty() || !f.dark_map.empty()) return;
    c.height_px = std::max<std::int64_t>(c.height_px, lines);
}

LabSetup lab_setup(const CameraModel& camera) {
    LabSetup s;
    s.camera = camera;
    set_window(s);
    s.filter = most_frequent_filter(s.camera);
    if (s.filter != 0)
        s.remarks.push_back(fmt::format("colour plane {}: the pixels under that filter", s.filter));
    s.wavelength_um = best_wavelength_um(camera, s.filter);
    s.grid = SpectralGrid({s.wavelength_um - 0.5 * kLine_um, s.wavelength_um + 0.5 * kLine_um});
    switch_off(s);
    choose_gains(s);
    set_black_level(s);
    choose_exposures(s);

    s.lamp_w_m2_um = 1;
    const double per_lamp =
        photons_per_s(s, evenly_lit(s, lab_selection(s))) * configured_quantum_efficiency(s) * s.exposure_s;
    s.lamp_w_m2_um = kOverexposure * configured_saturation_e(s.camera, s.gain_db) / per_lamp;
    return s;
}

PixelSelection lab_selection(const LabSetup& s) {
    const CameraModel& c = s.camera;
    const PixelRectangle w = window_of(c);
    const int margin_x = std::min(kWindowMargin_px, w.width / 8),
              margin_y = std::min(kWindowMargin_px, w.height / 8);
    PixelSelection out(static_cast<int>(c.black_columns) + margin_x,
                       static_cast<int>(c.black_rows) + margin_y, w.width - 2 * margin_x,
                       w.height - 2 * margin_y);
    if (s.filter == 0) return out;
    const std::vector<std::string> rows = pattern_rows(c.color_filter.pattern);
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x)
            out.use[static_cast<std::size_t>(y) * static_cast<std::size_t>(out.width) +
                    static_cast<std::size_t>(x)] =
                letter_at(rows, w.left + margin_x + x, w.top + margin_y + y) == s.filter ? 1 : 0;
    return out;
}

namespace {

// Calls visit(index of the pixel, relative illumination) for the pixels that count.
template <class Visit>
void visit_light(const LabSetup& s, const PixelSelection& selection, const Visit& visit) {
    const RelativeIllumination lens(s.camera, geometry_of(s.camera, 0));
    std::size_t i = 0;
    for (int y = 0; y < selection.height; ++y)
        for (int x = 0; x < selection.width; ++x, ++i)
            if (selection.use[i])
                visit(i, lens.at(selection.left - static_cast<double>(s.camera.black_columns) + x + 0.5,
                                 selection.top - static_cast<double>(s.camera.black_rows) + y + 0.5));
}

}  // namespace

PixelSelection evenly_lit(const LabSetup& s, PixelSelection selection) {
    double most = 0;
    visit_light(s, selection, [&](std::size_t, double light) { most = std::max(most, light); });
    const PixelSelection all = selection;
    visit_light(s, all,
                [&](std::size_t i, double light) { selection.use[i] = light >= 0.99 * most ? 1 : 0; });
    return selection;
}

double photons_per_s(const LabSetup& s, const PixelSelection& selection) {
    const CameraModel& c = s.camera;
    double sum = 0;
    visit_light(s, selection, [&](std::size_t, double light) { sum += light; });
    const double radiance_w_m2_sr_um = s.lamp_w_m2_um / kPi;
    const double pixel_rad = c.pitch_m / c.focal_length_m;
    const double power_w = radiance_w_m2_sr_um * s.grid.width_um(0) * aperture_area_m2(c) * pixel_rad *
                           pixel_rad * c.fill_factor * lens_transmission(c, s.wavelength_um);
    return power_w / photon_energy_j(s.wavelength_um) * sum / static_cast<double>(selection.count());
}

double configured_quantum_efficiency(const LabSetup& s) {
    const Curve* filter = filter_curve(s.camera, s.filter);
    return s.camera.quantum_efficiency.at(s.wavelength_um) * (filter ? filter->at(s.wavelength_um) : 1);
}

double configured_signal_dn(const CameraModel& c, double charge_e, double gain_db) {
    const double linear = c.system_gain_dn_e(gain_db) * c.read_e(charge_e) + c.offset_dn;
    const double max_dn = std::exp2(static_cast<double>(c.bits)) - 1;
    const auto bent = [&](double dn) {
        const double z = dn / max_dn;
        return std::min(dn + 4 * c.converter.inl_lsb * z * (1 - z), max_dn);
    };
    return bent(std::min(linear, max_dn)) - bent(c.offset_dn);
}

double configured_saturation_e(const CameraModel& c, double gain_db) {
    const double end_dn = configured_signal_dn(c, c.full_well_e, gain_db);
    double least = 0, most = c.full_well_e;
    // Finds the smallest charge with the reading of a full well; readings rise with charge up to the
    // converter's end.
    for (int step = 0; step < 60; ++step) {
        const double middle = 0.5 * (least + most);
        (configured_signal_dn(c, middle, gain_db) < end_dn * (1 - 1e-12) ? least : most) = middle;
    }
    return most;
}

}  // namespace hilcam
