// The report of `hilcam bench --error`: JSON for scripts, a table for people.

#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>

#include "emulator/recording/machine_report.h"
#include "emulator/run/report.h"
#include "emulator/tradeoff/error_bench.h"

namespace hilcam {
namespace {

using nlohmann::json;

std::optional<double> if_lit(const NoiseError& of, double value) {
    return of.lit_px > 0 ? std::optional(value) : std::nullopt;
}

json figures_json(const ErrorFigures& f, std::uint64_t frames) {
    return {{"error_sigma_p99", or_null(if_lit(f.error, f.error.p99))},
            {"error_sigma_rms", or_null(if_lit(f.error, f.error.rms))},
            {"within_half_sigma_fraction", or_null(if_lit(f.error, f.error.within_half_fraction))},
            {"lit_px", static_cast<double>(f.error.lit_px) / static_cast<double>(frames)},
            {"false_lights", f.picture.false_lights},
            {"centroid_shift_px", or_null(f.picture.centroid_px)},
            {"photometric_error_fraction", or_null(f.picture.photometric_fraction)},
            {"limb_error_px", or_null(f.picture.limb_px)},
            {"ssim", or_null(f.picture.similarity)},
            {"scatter_sigma_p99", or_null(if_lit(f.scatter, f.scatter.p99))},
            {"scatter_sigma_rms", or_null(if_lit(f.scatter, f.scatter.rms))}};
}

json view_json(const ErrorView& view, std::uint64_t frames) {
    json out = figures_json(view, frames);
    const NoiseError& e = view.reference_standard_error;
    out["angle_deg"] = view.angle_deg;
    out["position_m"] = {view.position_m.x, view.position_m.y, view.position_m.z};
    out["reference"] = {{"frames", view.reference_frames},
                        {"seconds", view.reference_seconds},
                        {"standard_error_sigma_p99", or_null(if_lit(e, e.p99))},
                        {"standard_error_sigma_rms", or_null(if_lit(e, e.rms))},
                        {"lit_px", e.lit_px}};
    return out;
}

std::string cell(const std::optional<double>& value, int digits) {
    return value ? fmt::format("{:.{}f}", *value, digits) : std::string("-");
}

std::string row(const std::string& name, const ErrorFigures& f, const std::string& standard_error) {
    return fmt::format("{:>6} {:>8} {:>8} {:>7} {:>9} {:>9} {:>9} {:>8} {:>8} {:>9}\n", name,
                       cell(if_lit(f.error, f.error.p99), 3), cell(if_lit(f.error, f.error.rms), 3),
                       cell(f.picture.false_lights, 1), cell(f.picture.centroid_px, 4),
                       cell(f.picture.photometric_fraction, 5), cell(f.picture.limb_px, 4),
                       cell(if_lit(f.scatter, f.scatter.p99), 3), cell(if_lit(f.scatter, f.scatter.rms), 3),
                       standard_error);
}

}  // namespace

json error_bench_json(const ErrorBench& b) {
    json views = json::array();
    for (const ErrorView& view : b.views) views.push_back(view_json(view, b.frames_per_view));
    return {{"scenario", b.scenario},
            {"width", b.width_px},
            {"height", b.height_px},
            {"views", views},
            {"all_views", figures_json(b.all_views, b.frames_per_view)},
            {"frames_per_view", b.frames_per_view},
            {"reference_set", b.reference_set},
            {"machine", machine_report()}};
}

std::string error_bench_text(const ErrorBench& b) {
    std::string out = fmt::format(
        "{}: number of views {}, of frames in each {}; in sensor noise: error, scatter, and the standard "
        "error of the reference\n\n"
        "{:>6} {:>8} {:>8} {:>7} {:>9} {:>9} {:>9} {:>8} {:>8} {:>9}\n"
        "{:>6} {:>8} {:>8} {:>7} {:>9} {:>9} {:>9} {:>8} {:>8} {:>9}\n",
        b.scenario, b.views.size(), b.frames_per_view, "view", "error", "error", "false", "centroid",
        "photom.", "limb", "scatter", "scatter", "reference", "deg", "p99", "rms", "lights", "px", "fraction",
        "px", "p99", "rms", "p99");
    for (const ErrorView& view : b.views) {
        const NoiseError& e = view.reference_standard_error;
        out += row(fmt::format("{:.0f}", view.angle_deg), view, cell(if_lit(e, e.p99), 3));
    }
    return out + row("all", b.all_views, "");
}

}  // namespace hilcam
