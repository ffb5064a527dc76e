// Reports of `hilcam bench --error --zoo`: JSON for scripts, a table for people.

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "emulator/recording/machine_report.h"
#include "emulator/run/report.h"
#include "emulator/zoo/zoo_bench.h"
#include "render/vocabulary/median.h"

namespace hilcam {
namespace {

using nlohmann::json;

std::optional<double> share_of(std::size_t part, std::size_t all) {
    return all > 0 ? std::optional(static_cast<double>(part) / static_cast<double>(all)) : std::nullopt;
}
std::optional<double> if_any(bool any, double value) { return any ? std::optional(value) : std::nullopt; }

// A column of the table: its title in two lines, its name in JSON, and its value; empty: the picture contains
// nothing of that kind.
struct ZooColumn {
    const char* above;
    const char* below;
    const char* key;
    int digits;
    double factor;  // factor on the value in the table
    std::optional<double> (*value)(const ZooFigures&);
};
constexpr std::array kColumns = {
    ZooColumn{"error", "p99", "error_sigma_p99", 2, 1,
              [](const ZooFigures& f) { return if_any(f.error.lit_px > 0, f.error.p99); }},
    ZooColumn{"error", "rms", "error_sigma_rms", 2, 1,
              [](const ZooFigures& f) { return if_any(f.error.lit_px > 0, f.error_rms); }},
    ZooColumn{"ref.", "p99", "reference_sigma_p99", 2, 1,
              [](const ZooFigures& f) { return if_any(f.error.lit_px > 0, f.reference.p99); }},
    ZooColumn{"ref.", "rms", "reference_sigma_rms", 2, 1,
              [](const ZooFigures& f) { return if_any(f.error.lit_px > 0, f.reference.rms); }},
    ZooColumn{"blocks", ">10 %", "blocks_over_10_fraction", 2, 100,
              [](const ZooFigures& f) { return share_of(f.blocks.over_10, f.blocks.judged); }},
    ZooColumn{"blocks", ">25 %", "blocks_over_25_fraction", 2, 100,
              [](const ZooFigures& f) { return share_of(f.blocks.over_25, f.blocks.judged); }},
    ZooColumn{"grid", "ratio", "grid_energy_ratio", 2, 1,
              [](const ZooFigures& f) { return if_any(f.grid.ratio() > 0, f.grid.ratio()); }},
    ZooColumn{"pan", "rms", "pan_sigma_rms", 2, 1,
              [](const ZooFigures& f) { return if_any(f.pan.lit_px > 0, f.pan.excess_rms()); }},
    ZooColumn{"false", "lights", "false_lights", 0, 1,
              [](const ZooFigures& f) { return std::optional(f.false_lights); }},
    ZooColumn{"lost", "lights", "lost_lights", 0, 1,
              [](const ZooFigures& f) { return std::optional(f.lost_lights); }},
    ZooColumn{"centre", "px", "centroid_shift_px", 3, 1, [](const ZooFigures& f) { return f.centroid_px; }},
    ZooColumn{"light", "%", "photometric_error_fraction", 2, 100,
              [](const ZooFigures& f) { return f.photometric_fraction; }},
    ZooColumn{"frame", "core-ms", "core_ms", 1, 1,
              [](const ZooFigures& f) { return std::optional(f.core_ms); }},
};

json figures_json(const ZooFigures& f) {
    json out;
    for (const ZooColumn& column : kColumns) out[column.key] = or_null(column.value(f));
    out["lit_px"] = f.error.lit_px;
    out["blocks_judged"] = f.blocks.judged;
    out["blocks_unknown"] = f.blocks.unknown;
    out["pan_reference_sigma_rms"] = or_null(if_any(f.pan.lit_px > 0, f.pan.reference_rms()));
    for (std::size_t p = 0; p < kGridPeriods_px.size(); ++p)
        out["grid_energy_ratio_by_period_px"][std::to_string(kGridPeriods_px[p])] =
            or_null(if_any(f.grid.beside[p] > 0, f.grid.ratio(p)));
    return out;
}

json member_json(const ZooMember& member) {
    json views = json::array();
    for (const ZooViewFigures& view : member.views) {
        json one = figures_json(view);
        one["view"] = view.name;
        one["set"] = view.overrides;
        one["reference"] = {{"frames", view.reference_frames}, {"seconds", view.reference_seconds}};
        views.push_back(std::move(one));
    }
    return {{"name", member.name},
            {"scenario", member.scenario},
            {"set", member.overrides},
            {"width", member.width_px},
            {"height", member.height_px},
            {"views", std::move(views)},
            {"all_views", figures_json(member.all)}};
}

// Summarises a figure over all members that have it.
template <class Summary>
std::optional<double> over_members(const ZooBench& zoo, const ZooColumn& column, const Summary& summary) {
    std::vector<double> values;
    for (const ZooMember& member : zoo.members)
        if (const std::optional<double> value = column.value(member.all)) values.push_back(*value);
    return values.empty() ? std::nullopt : std::optional(summary(values));
}
double worst_of(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }

template <class Summary>
json summary_json(const ZooBench& zoo, const Summary& summary) {
    json out;
    for (const ZooColumn& column : kColumns) out[column.key] = or_null(over_members(zoo, column, summary));
    return out;
}

constexpr int kWidth = 9;

template <class ValueOf>
std::string row(const std::string& name, std::size_t name_width, const ValueOf& value_of) {
    std::string out = fmt::format("{:<{}}", name, name_width);
    for (const ZooColumn& column : kColumns) {
        const std::optional<double> value = value_of(column);
        out += value ? fmt::format("{:>{}.{}f}", column.factor * *value, kWidth, column.digits)
                     : fmt::format("{:>{}}", "-", kWidth);
    }
    return out + "\n";
}

std::string heading(const std::string& name, std::size_t name_width, const char* ZooColumn::*line) {
    std::string out = fmt::format("{:<{}}", name, name_width);
    for (const ZooColumn& column : kColumns) out += fmt::format("{:>{}}", column.*line, kWidth);
    return out + "\n";
}

}  // namespace

json zoo_bench_json(const ZooBench& zoo) {
    json members = json::array();
    for (const ZooMember& member : zoo.members) members.push_back(member_json(member));
    return {{"members", std::move(members)},       {"worst", summary_json(zoo, worst_of)},
            {"median", summary_json(zoo, median)}, {"views", zoo.all_views ? "all" : "few"},
            {"picture_px", zoo.picture_px},        {"set", zoo.overrides},
            {"machine", machine_report()}};
}

std::string zoo_bench_text(const ZooBench& zoo) {
    std::size_t width = std::string("median").size();
    for (const ZooMember& member : zoo.members) width = std::max(width, member.name.size());
    std::string out = heading("", width, &ZooColumn::above) + heading("member", width, &ZooColumn::below);
    for (const ZooMember& member : zoo.members)
        out += row(member.name, width, [&](const ZooColumn& column) { return column.value(member.all); });
    out += "\n";
    out += row("worst", width, [&](const ZooColumn& column) { return over_members(zoo, column, worst_of); });
    return out +
           row("median", width, [&](const ZooColumn& column) { return over_members(zoo, column, median); });
}

}  // namespace hilcam
