#include "emulator/characterise/characterise_report.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "emulator/run/page_maker.h"
#include "emulator/run/report.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

using nlohmann::json;

json figure_json(const SheetFigure& f) {
    return {{"configured", f.configured},
            {"measured", f.measured.value},
            {"uncertainty", f.measured.uncertainty}};
}

json parts(const Nonuniformity& n) {
    const auto part = [](const Measured& m) {
        return json{{"measured", m.value}, {"uncertainty", m.uncertainty}};
    };
    return {
        {"total", part(n.total)}, {"row", part(n.row)}, {"column", part(n.column)}, {"pixel", part(n.pixel)}};
}

// Statistics of a map over the window, added to what is drawn for each pixel.
struct MapStatistics {
    double mean = 0, deviation = 0;
};
MapStatistics statistics_of(const PixelMap& map, const CameraModel& c) {
    if (map.width() == 0) return {};
    const PixelRectangle w = window_of(c);
    double sum = 0, square = 0;
    for (int y = w.top; y < w.top + w.height; ++y)
        for (int x = w.left; x < w.left + w.width; ++x) {
            const double value = static_cast<double>(map.row(y)[static_cast<std::size_t>(x)]);
            sum += value, square += value * value;
        }
    const double n = static_cast<double>(w.width) * w.height;
    return {sum / n, std::sqrt(std::max(0.0, square / n - sum / n * (sum / n)))};
}

// Removes a remainder that is only rounding after subtraction of the line.
double without_rounding(double fraction) { return std::abs(fraction) < 1e-9 ? 0 : fraction; }

// Makes 101 cells over the range of the pixels that count.
json histogram(const std::vector<double>& image, double scale) {
    constexpr std::size_t kCells = 101;
    if (image.empty() || !(scale > 0)) return nullptr;
    std::vector<int> count(kCells, 0);
    constexpr double kReach = 6;
    for (const double value : image) {
        const double cell = (value / scale / kReach + 1) / 2 * kCells;
        if (cell >= 0 && cell < kCells) ++count[static_cast<std::size_t>(cell)];
    }
    json out = json::array();
    for (std::size_t i = 0; i < kCells; ++i)
        out.push_back({{"deviation", (2 * (static_cast<double>(i) + 0.5) / kCells - 1) * kReach * scale},
                       {"pixels", count[i]}});
    return out;
}

json light_json(const Characterisation& r) {
    std::vector<LightPoint> points;
    for (const LightLevel& level : r.light) points.push_back(level.point);
    const std::size_t saturation = saturation_index(points);
    json out = json::array();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const LightLevel& level = r.light[i];
        const LightPoint& p = level.point;
        out.push_back({{"exposure_s", level.exposure_s},
                       {"filter", level.filter},
                       {"photons", p.photons},
                       {"mean_dn", p.light.mean_dn.value},
                       {"variance_dn2", p.light.variance_dn2.value},
                       {"dark_mean_dn", p.dark.mean_dn.value},
                       {"dark_variance_dn2", p.dark.variance_dn2.value},
                       {"signal_dn", p.signal_dn()},
                       {"shot_variance_dn2", p.shot_dn2()},
                       {"saturated", i > saturation},
                       {"snr", p.signal_dn() / std::sqrt(p.light.variance_dn2.value)}});
    }
    return out;
}

json linearity_json(const Characterisation& r) {
    json out = json::array();
    for (const LinearityPoint& p : r.linearity.points)
        out.push_back({{"photons", p.photons},
                       {"signal_dn", p.signal_dn},
                       {"fit_dn", p.fit_dn},
                       {"deviation_fraction", p.deviation_fraction}});
    return out;
}

json dark_json(const Characterisation& r) {
    json out = json::array();
    for (const DarkPoint& p : r.dark)
        out.push_back({{"exposure_s", p.exposure_s},
                       {"mean_dn", p.dark.mean_dn.value},
                       {"mean_uncertainty_dn", p.dark.mean_dn.uncertainty},
                       {"variance_dn2", p.dark.variance_dn2.value},
                       {"row_variance_dn2", p.dark.row_dn2}});
    return out;
}

json mtf_points(const MtfCurve& m) {
    json points = json::array();
    for (std::size_t i = 0; i < m.measured.size(); ++i)
        points.push_back({{"frequency_cy_px", m.frequency_cy_px[i]},
                          {"configured", m.configured[i]},
                          {"measured", m.measured[i]},
                          {"uncertainty", m.uncertainty[i]}});
    return points;
}

json mtf_json(const MtfCurve& m) {
    return {{"normal_deg", m.normal_rad / kDegree_rad}, {"points", mtf_points(m)}};
}

json settings_json(const Characterisation& r) {
    const LabSetup& s = r.setup;
    return {{"window_px", s.camera.window_px},
            {"wavelength_um", s.wavelength_um},
            {"color_filter", s.filter ? json(std::string(1, s.filter)) : json(nullptr)},
            {"gain_db", s.gain_db},
            {"dark_gain_db", s.dark_gain_db},
            {"offset_dn", s.camera.offset_dn},
            {"exposure_s", s.exposure_s},
            {"levels_by", s.by_light ? "light" : "exposure time"},
            {"dark_exposure_s", {s.shortest_s, s.longest_s}},
            {"shot_noise_bandwidth", r.shot_bandwidth},
            {"read_noise_bandwidth", r.read_bandwidth},
            {"pixels", r.pixels},
            {"frames", r.frames},
            {"remarks", s.remarks}};
}

}  // namespace

std::vector<SheetFigure> sheet_figures(const Characterisation& r, const DetectorPictures& pictures) {
    const CameraModel& c = r.setup.camera;
    const double gain = c.system_gain_dn_e(r.setup.gain_db);
    const double saturation_e = configured_saturation_e(c, r.setup.gain_db);
    const double noise_e = c.dark_noise_e();
    const double dark_e_s =
        pictures.dark_e_s.width() > 0 ? statistics_of(pictures.dark_e_s, c).mean : c.dark_current_now_e_s();
    const double prnu = std::hypot(c.prnu_fraction, statistics_of(pictures.prnu, c).deviation);
    const double dsnu_e = std::hypot(c.dsnu_e, statistics_of(pictures.offset_e, c).deviation);
    const double linearity = without_rounding(r.configured_linearity.error_fraction.value);
    // All lines of a line camera come from one row of pixels, so differences between pixels appear as
    // columns.
    const bool lines = c.shutter.kind == ShutterKind::kLineScan;
    const Measured threshold = absolute_threshold_e(r.dark_noise_e, r.gain_dn_e);
    const Measured threshold_made = absolute_threshold_e({noise_e, 0}, {gain, 0});
    const std::size_t nyquist = r.horizontal.nyquist();
    const auto mtf = [&](const char* key, const char* label, const MtfCurve& m) {
        return SheetFigure{
            key, label, "", 1, m.configured[nyquist], {m.measured[nyquist], m.uncertainty[nyquist]}};
    };
    return {
        {"gain_dn_e", "System gain K", "DN/e-", 1, gain, r.gain_dn_e},
        {"qe_peak", "Quantum efficiency", "%", 100, configured_quantum_efficiency(r.setup),
         r.quantum_efficiency},
        {"read_noise_e", "Temporal dark noise", "e-", 1, noise_e, r.dark_noise_e},
        {"dark_current_e_s", "Dark current", "e-/s", 1, dark_e_s, r.dark_current.from_mean_e_s},
        {"full_well_e", "Full well", "e-", 1, saturation_e, r.full_well_e},
        {"saturation_capacity_e", "Saturation capacity", "e-", 1, saturation_e, r.saturation_capacity_e},
        {"snr_max_db", "SNR max", "dB", 1, snr_max_db({saturation_e, 0}).value,
         snr_max_db(r.saturation_capacity_e)},
        {"absolute_threshold_e", "Absolute threshold", "e-", 1, threshold_made.value, threshold},
        {"dynamic_range_db", "Dynamic range", "dB", 1,
         dynamic_range_db({saturation_e, 0}, threshold_made).value,
         dynamic_range_db(r.saturation_capacity_e, threshold)},
        {"prnu_fraction", "PRNU", "%", 100, prnu, lines ? r.prnu_fraction.column : r.prnu_fraction.pixel},
        {"dsnu_e", "DSNU", "e-", 1, dsnu_e, lines ? r.dsnu_e.column : r.dsnu_e.pixel},
        {"linearity_error", "Linearity error", "%", 100, linearity, r.linearity.error_fraction},
        mtf("mtf_nyquist", "MTF at Nyquist, rows", r.horizontal),
        mtf("mtf_nyquist_vertical", "MTF at Nyquist, columns", r.vertical),
        {"gain_standard_dn_e", nullptr, "DN/e-", 1, gain, r.standard_gain_dn_e},
        {"dark_current_from_variance_e_s", nullptr, "e-/s", 1, dark_e_s, r.dark_current.from_variance_e_s},
    };
}

json characterisation_json(const Characterisation& r, const DetectorPictures& pictures) {
    json out = {
        {"camera", r.setup.camera.name},
        {"linearity_extremes_fraction", {r.linearity.min_fraction, r.linearity.max_fraction}},
        {"prnu", parts(r.prnu_fraction)},
        {"dsnu", parts(r.dsnu_e)},
        {"defects", r.defects},
        {"photon_transfer", light_json(r)},
        {"linearity", linearity_json(r)},
        {"dark", dark_json(r)},
        {"prnu_histogram", histogram(r.prnu_fraction.image, r.prnu_fraction.total.value)},
        {"dsnu_histogram", histogram(r.dsnu_e.image, r.dsnu_e.total.value)},
        {"mtf", {{"horizontal", mtf_json(r.horizontal)}, {"vertical", mtf_json(r.vertical)}}},
        {"settings", settings_json(r)},
    };
    for (const SheetFigure& f : sheet_figures(r, pictures)) out[f.key] = figure_json(f);
    return out;
}

// --- a table ---

std::string characterisation_table(const Characterisation& r, const DetectorPictures& pictures) {
    std::string out = fmt::format("{}\n\n{:<26}{:>6}{:>14}{:>14}{:>14}{:>12}\n", r.setup.camera.name, "", "",
                                  "measured", "configured", "uncertainty", "deviation");
    for (const SheetFigure& f : sheet_figures(r, pictures)) {
        if (!f.label) continue;
        const double measured = f.measured.value;
        const std::string deviation = std::abs(f.configured) > 1e-9
                                          ? fmt::format("{:+.2f} %", 100 * (measured / f.configured - 1))
                                          : "-";
        out += fmt::format("{:<26}{:>6}{:>14.5g}{:>14.5g}{:>14.2g}{:>12}\n", f.label, f.unit,
                           f.factor * measured, f.factor * f.configured, f.factor * f.measured.uncertainty,
                           deviation);
    }
    out += fmt::format("\n{} pixels, {} defects left out; light of {:.0f} nm\n", r.pixels, r.defects,
                       1000 * r.setup.wavelength_um);
    for (const std::string& remark : r.setup.remarks) out += remark + "\n";
    return out;
}

// --- a folder ---

namespace {

void write_csv(const std::filesystem::path& file, const json& points) {
    if (!points.is_array() || points.empty()) return;
    std::ofstream out(file);
    const auto write_line = [&](const json& point, const auto& cell) {
        const char* separator = "";
        for (const auto& [key, value] : point.items()) out << separator << cell(key, value), separator = ",";
        out << "\n";
    };
    write_line(points.front(), [](const std::string& key, const json&) { return key; });
    for (const json& point : points)
        write_line(point, [](const std::string&, const json& value) { return value.dump(); });
    out.close();
    if (!out) throw DeviceError(file.string() + ": cannot be written");
}

}  // namespace

void write_characterisation(const Characterisation& r, const DetectorPictures& pictures,
                            const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw DeviceError(folder.string() + ": cannot be made: " + error.message());
    write_json(folder / "characterise.json", characterisation_json(r, pictures));
    write_csv(folder / "photon_transfer.csv", light_json(r));
    write_csv(folder / "linearity.csv", linearity_json(r));
    write_csv(folder / "dark.csv", dark_json(r));
    write_csv(folder / "mtf_horizontal.csv", mtf_points(r.horizontal));
    write_csv(folder / "mtf_vertical.csv", mtf_points(r.vertical));
    run_page_maker("hilcam-plot-characterise",
                   {(folder / "characterise.json").string(), (folder / "index.html").string()});
}

}  // namespace hilcam
