#include "emulator/clone/clone_report.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "emulator/clone/clone_figures.h"
#include "emulator/progress/progress.h"
#include "emulator/run/page_maker.h"
#include "emulator/run/report.h"
#include "emulator/scenario/scene_loader.h"
#include "io/config/config_yaml.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

using nlohmann::json;

std::size_t count_of(const CloneMeasurement& m, DefectKind kind) {
    return static_cast<std::size_t>(std::count_if(m.defects.begin(), m.defects.end(),
                                                  [kind](const ListedDefect& d) { return d.kind == kind; }));
}

// Makes 121 cells over six standard deviations to both sides, of the pixels that count.
json histogram(const PixelValues& map, const PixelSelection& good) {
    constexpr std::size_t kCells = 121;
    constexpr double kReach = 6;
    if (map.value.empty()) return nullptr;
    double sum = 0, square = 0, count = 0;
    for (std::size_t i = 0; i < map.value.size(); ++i)
        if (good.use[i]) sum += map.value[i], square += map.value[i] * map.value[i], ++count;
    const double mean = sum / count, sigma = std::sqrt(std::max(0.0, square / count - mean * mean));
    if (!(sigma > 0)) return nullptr;
    std::vector<int> cells(kCells, 0);
    for (std::size_t i = 0; i < map.value.size(); ++i) {
        const double cell = ((map.value[i] - mean) / sigma / kReach + 1) / 2 * kCells;
        if (good.use[i] && cell >= 0 && cell < kCells) ++cells[static_cast<std::size_t>(cell)];
    }
    json out = json::array();
    for (std::size_t i = 0; i < kCells; ++i)
        out.push_back({{"deviation", (2 * (static_cast<double>(i) + 0.5) / kCells - 1) * kReach * sigma},
                       {"pixels", cells[i]}});
    return out;
}

// The root mean power of the rows' Fourier transforms, over at most 64 rows; defects count as the mean.
json spectrogram(const PixelValues& map, const CloneMeasurement& m) {
    constexpr int kRows = 64;
    if (map.value.empty() || m.width < 16) return nullptr;
    const auto width = static_cast<std::size_t>(m.width);
    std::vector<double> power(width / 2, 0.0);
    const int step = std::max(1, m.height / kRows);
    double rows = 0;
    for (int y = 0; y < m.height; y += step, ++rows) {
        const std::size_t first = static_cast<std::size_t>(y) * width;
        double sum = 0, count = 0;
        for (std::size_t x = 0; x < width; ++x)
            if (m.good.use[first + x]) sum += map.value[first + x], ++count;
        const double mean = sum / std::max(count, 1.0);
        for (std::size_t k = 1; k < power.size(); ++k) {
            const double angle = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(width);
            double real = 0, imaginary = 0;
            // One rotation a pixel in place of a cosine and a sine.
            double c = 1, s = 0;
            const double turn_c = std::cos(angle), turn_s = std::sin(angle);
            for (std::size_t x = 0; x < width; ++x) {
                const double value = m.good.use[first + x] ? map.value[first + x] - mean : 0;
                real += value * c, imaginary += value * s;
                const double next = c * turn_c - s * turn_s;
                s = c * turn_s + s * turn_c, c = next;
            }
            power[k] += (real * real + imaginary * imaginary) / static_cast<double>(width);
        }
    }
    json out = json::array();
    for (std::size_t k = 1; k < power.size(); ++k)
        out.push_back({{"frequency_cy_px", static_cast<double>(k) / static_cast<double>(width)},
                       {"amplitude", std::sqrt(power[k] / rows)}});
    return out;
}

json map_json(const PixelValues& map, const CloneMeasurement& m) {
    if (map.value.empty()) return nullptr;
    return {{"expected_correlation", map.spread.correlation()},
            {"histogram", histogram(map, m.good)},
            {"spectrogram", spectrogram(map, m)}};
}

json figures_json(const CloneMeasurement& m, const CameraModel& like) {
    json out;
    for (const CloneFigure& f : clone_figures(m, like)) {
        json one = {{"label", f.label},
                    {"unit", f.unit},
                    {"sheet", f.sheet},
                    {"measured", nullptr},
                    {"uncertainty", nullptr}};
        if (f.measured) one["measured"] = f.measured->value, one["uncertainty"] = f.measured->uncertainty;
        if (!f.measured) one["why"] = f.why;
        out[f.key] = std::move(one);
    }
    return out;
}

json light_json(const CloneMeasurement& m) {
    json out = json::array();
    for (const MeasuredLevel& level : m.light)
        out.push_back({{"light", level.point.photons},
                       {"charge_e", level.charge_e},
                       {"signal_dn", level.point.signal_dn()},
                       {"shot_variance_dn2", level.point.shot_dn2()},
                       {"saturated", level.saturated}});
    return out;
}

json dark_json(const CloneMeasurement& m) {
    json out = json::array();
    for (const MeasuredDark& d : m.dark)
        out.push_back({{"temperature_c", d.temperature_c},
                       {"exposure_s", d.point.exposure_s},
                       {"mean_dn", d.point.dark.mean_dn.value},
                       {"mean_uncertainty_dn", d.point.dark.mean_dn.uncertainty},
                       {"variance_dn2", d.point.dark.variance_dn2.value}});
    return out;
}

json linearity_json(const CloneMeasurement& m) {
    json out = json::array();
    if (!m.linearity) return out;
    for (const LinearityPoint& p : m.linearity->points)
        out.push_back(
            {{"light", p.photons}, {"signal_dn", p.signal_dn}, {"deviation_fraction", p.deviation_fraction}});
    return out;
}

// The lens's MTF at each image height, measured and as the clone has it.
json zones_json(const CloneOptics& o) {
    json out = json::array();
    if (!o.blur) return out;
    for (const LensZone& z : o.blur->zones) {
        json curve = json::array();
        for (std::size_t k = 0; k < z.mtf.size(); ++k)
            curve.push_back({{"frequency_cy_px", z.frequency_cy_px[k]},
                             {"measured", z.mtf[k]},
                             {"uncertainty", z.uncertainty[k]},
                             {"clone", z.described[k]}});
        out.push_back({{"field_fraction", z.field_fraction},
                       {"kind", o.blur->kind == BlurKind::kWavefront ? "wavefront" : "defocus"},
                       {"blur_m", z.blur_m.value},
                       {"uncertainty_m", z.blur_m.uncertainty},
                       {"misfit", z.misfit},
                       {"mtf", std::move(curve)}});
    }
    return out;
}

json lag_json(const CloneOptics& o) {
    json out = json::array();
    if (o.lag)
        for (const Measured& one : o.lag->left)
            out.push_back({{"fraction", one.value}, {"uncertainty", one.uncertainty}});
    return out;
}

// A line for each image height.
std::string zones_table(const CloneOptics& o) {
    if (!o.blur) return {};
    std::string out = "\nimage height   MTF at a quarter and half a cycle a pixel: measured, clone's\n";
    for (const LensZone& z : o.blur->zones) {
        out += fmt::format("{:>10.0f} %", 100 * z.field_fraction);
        for (const double f : {0.25, 0.5}) {
            const auto k = static_cast<std::size_t>(std::lround(f / z.frequency_cy_px[1]));
            out += fmt::format("   {:.3f} +- {:.3f}, {:.3f}", z.mtf[k], z.uncertainty[k], z.described[k]);
        }
        out += "\n";
    }
    return out;
}

std::string lag_table(const CloneOptics& o) {
    if (!o.lag) return {};
    std::string out = "lag, frame after frame:";
    for (const Measured& one : o.lag->left)
        out += fmt::format(" {:.2g} +- {:.1g},", one.value, one.uncertainty);
    out += " not emulated";
    if (o.lag->passed_over > 0) out += fmt::format("; {} partly lit frames passed over", o.lag->passed_over);
    return out + "\n";
}

}  // namespace

json clone_json(const CloneMeasurement& m, const CameraModel& like) {
    json currents = json::array();
    for (const DarkAtTemperature& d : m.dark_currents)
        currents.push_back({{"temperature_c", d.temperature_c},
                            {"dark_current_e_s", d.dark_current_e_s.value},
                            {"uncertainty", d.dark_current_e_s.uncertainty}});
    return {{"like", like.name},
            {"temperature_c", m.temperature_c},
            {"gain_db", m.gain_db},
            {"pixels", m.good.use.size()},
            {"good_pixels", m.good.count()},
            {"figures", figures_json(m, like)},
            {"dark_currents", std::move(currents)},
            {"photon_transfer", light_json(m)},
            {"linearity", linearity_json(m)},
            {"dark", dark_json(m)},
            {"offset_map", map_json(m.offset_e, m)},
            {"dark_map", map_json(m.dark_e_s, m)},
            {"gain_map", map_json(m.gain, m)},
            {"hot", count_of(m, DefectKind::kHot)},
            {"hot_limit_e_s", m.hot_limit_e_s},
            {"dead", count_of(m, DefectKind::kDead)},
            {"blinking", count_of(m, DefectKind::kBlinking)},
            {"field_zones", zones_json(m.optics)},
            {"lag", lag_json(m.optics)},
            {"remarks", m.remarks}};
}

std::string clone_table(const CloneMeasurement& m, const CameraModel& like) {
    std::string out =
        fmt::format("{:<28}{:>6}{:>14}{:>14}{:>14}\n", "", "", "measured", "uncertainty", like.name);
    for (const CloneFigure& f : clone_figures(m, like)) {
        out += fmt::format("{:<28}{:>6}", f.label, f.unit);
        out += f.measured ? fmt::format("{:>14.5g}{:>14.2g}", f.measured->value, f.measured->uncertainty)
                          : fmt::format("{:>14}{:>14}", "-", "-");
        out += fmt::format("{:>14.5g}{}\n", f.sheet, f.measured ? "" : "  " + f.why);
    }
    out += fmt::format(
        "\n{} of {} pixels are without defect; {} hot (by more than {:.3g} e-/s), {} dead, {} blinking\n",
        m.good.count(), m.good.use.size(), count_of(m, DefectKind::kHot), m.hot_limit_e_s,
        count_of(m, DefectKind::kDead), count_of(m, DefectKind::kBlinking));
    const auto correlation = [](const PixelValues& map) {
        return map.value.empty() ? std::string("-") : fmt::format("{:.3f}", map.spread.correlation());
    };
    out += fmt::format(
        "expected correlation of the maps with the camera's own: offset {}, dark current {}, gain {}\n",
        correlation(m.offset_e), correlation(m.dark_e_s), correlation(m.gain));
    out += zones_table(m.optics) + lag_table(m.optics);
    for (const std::string& remark : m.remarks) out += remark + "\n";
    return out;
}

std::vector<BenchSeries> bench_series(const FrameSet& frames, const CloneMeasurement& m) {
    std::vector<BenchSeries> out;
    for (std::size_t i = 0; i < frames.series.size(); ++i) {
        BenchSeries series{frames.series[i], 0};
        series.settings.read = {};
        for (const MeasuredLevel& level : m.light)
            if (level.series == i) series.charge_e = level.charge_e;
        out.push_back(std::move(series));
    }
    // Saturated flats were brighter than their signal tells: all of them get at least a third more.
    for (const MeasuredLevel& level : m.light)
        if (level.saturated) out[level.series].charge_e *= 1.33;
    return out;
}

void write_comparison(const CloneMeasurement& real, const FrameSet& frames, const CameraModel& like,
                      const std::filesystem::path& camera_file, const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw DeviceError(folder.string() + ": cannot be made: " + error.message());
    CameraModel camera;
    read_config(camera_file, section_of(camera));
    constexpr std::uint64_t kSeed = 1288;
    const FrameSet emulated =
        bench_frames(camera, load_detector_pictures(camera), bench_series(frames, real), kSeed);
    Progress progress("emulated camera", 1);
    const CloneMeasurement again = measure_clone(emulated, like, [&](double share) { progress.done(share); });
    write_json(folder / "clone.json", clone_json(real, like));
    write_json(folder / "emulated.json", clone_json(again, like));
    run_page_maker("hilcam-plot-clone",
                   {(folder / "clone.json").string(), (folder / "emulated.json").string(),
                    (folder / "index.html").string()});
}

}  // namespace hilcam
