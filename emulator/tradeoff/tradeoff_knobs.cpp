#include "emulator/tradeoff/tradeoff_knobs.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "io/config/config_manual.h"
#include "io/config/config_yaml.h"
#include "render/vocabulary/plain_number.h"

namespace hilcam {
namespace {

// The parts of a scenario without which a knob has no effect.
enum class Needs { kNothing, kSurfaces, kMeshes, kTerrain, kAir };

struct KnobRow {
    const char* name;
    const char* key;
    std::vector<const char*> values;
    Needs needs = Needs::kNothing;
    KnobRole role = KnobRole::kAlways;
};

// Returns the knobs with their values from fast to accurate.
const std::vector<KnobRow>& knob_rows() {
    static const std::vector<KnobRow> rows = {
        {"path model",
         "quality.path_model",
         {"direct", "cached", "path"},
         Needs::kSurfaces,
         KnobRole::kPathModel},
        {"depth", "quality.max_depth", {"1", "2", "3", "4", "6"}, Needs::kSurfaces, KnobRole::kDepth},
        {"visibility", "quality.visibility", {"rays", "buffer"}, Needs::kMeshes},
        {"samples per axis", "quality.samples_per_axis", {"1", "2", "3", "4"}},
        {"contribution threshold",
         "quality.contribution_threshold",
         {"0.5", "0.02", "0.001"},
         Needs::kSurfaces,
         KnobRole::kBounces},
        {"Sun's disk", "quality.sun_disk", {"false", "true"}, Needs::kSurfaces},
        {"facets behind diffuse",
         "quality.facets_behind_diffuse",
         {"0.4", "0.2", "0"},
         Needs::kSurfaces,
         KnobRole::kBounces},
        {"LOD error px", "quality.lod_error_px", {"2", "1", "0.5", "0.25", "0"}, Needs::kMeshes},
        {"precision (watertight)", "quality.watertight", {"false", "true"}, Needs::kSurfaces},
        {"rays across", "quality.rays_across", {"0", "64", "128", "512"}, Needs::kMeshes},
        {"point samples", "quality.point_samples", {"32", "96", "256"}, Needs::kMeshes},
        {"terrain edge px", "terrain.edge_px", {"4", "2", "1"}, Needs::kTerrain},
        {"PSF method", "quality.psf", {"auto", "fft"}},
        {"oversampling", "quality.oversampling", {"1", "2", "3"}},
        {"guard px", "quality.guard_px", {"8", "28", "64"}},
        {"atmosphere", "atmosphere.model", {"none", "precomputed"}, Needs::kAir},
    };
    return rows;
}

bool useful(Needs needs, const ScenarioConfig& s) {
    switch (needs) {
        case Needs::kNothing:
            return true;
        case Needs::kSurfaces:
            return !s.objects.empty() || s.terrain;
        case Needs::kMeshes:
            return !s.objects.empty();
        case Needs::kTerrain:
            return s.terrain.has_value();
        case Needs::kAir:
            return s.atmosphere.model != "none";
    }
    return false;
}

std::string text_of(ScenarioConfig& scenario, std::string_view key) {
    return value_text(section_of(scenario), key);
}

Knob knob_of(const KnobRow& row, const ScenarioSource& source, ScenarioConfig& own) {
    Knob knob{row.name, {text_of(own, row.key), {}}, {}, row.role};
    for (const char* value : row.values) {
        const std::string override = fmt::format("{}={}", row.key, value);
        ScenarioConfig other = source.load({override});
        if (text_of(other, row.key) != knob.own.label) knob.others.push_back({value, {override}});
    }
    return knob;
}

// The knob for sub-steps of an exposure; their number follows from the allowed length of a step.
Knob motion_knob(const ScenarioConfig& own) {
    constexpr double kSteps_px[] = {1, 0.25};
    const auto exact = [](double step_px) { return fmt::format("exact, {} px", step_px); };
    constexpr const char* kWords[] = {"off", "fast", "exact"};
    const MotionQuality motion = own.quality.motion;
    Knob knob{"motion",
              {motion == MotionQuality::kExact ? exact(own.quality.motion_error_px)
                                               : kWords[static_cast<std::size_t>(motion)],
               {}},
              {},
              KnobRole::kAlways};
    const auto add = [&](std::string label, std::vector<std::string> overrides) {
        if (label != knob.own.label) knob.others.push_back({std::move(label), std::move(overrides)});
    };
    for (const char* word : {"off", "fast"}) add(word, {fmt::format("quality.motion={}", word)});
    for (const double step_px : kSteps_px)
        add(exact(step_px), {"quality.motion=exact", fmt::format("quality.motion_error_px={}", step_px)});
    return knob;
}

std::string edges_override(const std::vector<double>& edges_um) {
    std::string list;
    for (const double edge : edges_um) list += (list.empty() ? "" : ", ") + plain(edge);
    return fmt::format("spectrum_edges_um=[{}]", list);
}

// Returns the oversampling of the reference, as much as fits into two images of 1 GiB with 8 bins. Detail
// finer than a pixel of the radiance image aliases before the lens attenuates it; this costs 8 % of an edge's
// height, and falls with the square of the oversampling (docs/sensor.md).
std::int64_t reference_oversampling(const ScenarioConfig& s, std::int64_t guard_px) {
    constexpr std::int64_t kMaxPixels = std::int64_t{1} << 25;
    const PixelRectangle w = window_of(s.camera);
    const std::int64_t pixels = (w.width + 2 * guard_px) * (w.height + 2 * guard_px);
    std::int64_t m = 4;
    while (m > 1 && m * m * pixels > kMaxPixels) --m;
    return std::max(m, s.quality.oversampling);
}

Knob bins_knob(const ScenarioConfig& own) {
    const std::size_t bins = own.spectrum_edges_um.size() - 1;
    Knob knob{"spectral bins", {std::to_string(bins), {}}, {}, KnobRole::kAlways};
    std::vector<std::size_t> counts = {1, bins / 2, 2 * bins};
    std::sort(counts.begin(), counts.end());
    counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
    for (const std::size_t count : counts)
        if (count > 0 && count != bins && count <= static_cast<std::size_t>(kMaxBins))
            knob.others.push_back(
                {std::to_string(count), {edges_override(regrouped_edges_um(own.spectrum_edges_um, count))}});
    return knob;
}

}  // namespace

std::vector<std::string> joined_overrides(const std::vector<std::string>& first,
                                          const std::vector<std::string>& second) {
    const auto key_of = [](const std::string& text) {
        return std::string_view(text).substr(0, text.find('='));
    };
    std::vector<std::string> all;
    for (const std::vector<std::string>* list : {&first, &second})
        for (const std::string& text : *list) {
            std::erase_if(all, [&](const std::string& earlier) { return key_of(earlier) == key_of(text); });
            all.push_back(text);
        }
    return all;
}

ScenarioConfig ScenarioSource::load(const std::vector<std::string>& more) const {
    return load_scenario(file, joined_overrides(overrides, more));
}

std::vector<Knob> knobs_of(const ScenarioSource& source) {
    ScenarioConfig own = source.load();
    std::vector<Knob> knobs;
    for (const KnobRow& row : knob_rows())
        if (useful(row.needs, own)) knobs.push_back(knob_of(row, source, own));
    knobs.push_back(motion_knob(own));
    knobs.push_back(bins_knob(own));
    std::erase_if(knobs, [](const Knob& knob) { return knob.others.empty(); });
    return knobs;
}

void reset_idle(const std::vector<Knob>& knobs, std::vector<std::size_t>& choices) {
    bool direct = false, one_surface = false;
    for (std::size_t k = 0; k < knobs.size(); ++k) {
        const std::string& label = knobs[k].value(choices[k]).label;
        if (knobs[k].role == KnobRole::kPathModel) direct = label == "direct";
        if (knobs[k].role == KnobRole::kDepth) one_surface = label == "1";
    }
    for (std::size_t k = 0; k < knobs.size(); ++k)
        if ((direct && knobs[k].role == KnobRole::kDepth) ||
            ((direct || one_surface) && knobs[k].role == KnobRole::kBounces))
            choices[k] = 0;
}

std::vector<std::string> reference_overrides(const ScenarioConfig& s) {
    const std::int64_t guard_px = std::max<std::int64_t>(64, s.quality.guard_px);
    const std::int64_t oversampling = reference_oversampling(s, guard_px);
    constexpr std::int64_t kRaysPerAxis = 8;  // at least this many for each detector pixel
    std::vector<std::string> out = {
        "quality.path_model=path",
        // A ninth surface adds less than 0.9^8 of what nearly white surfaces reflect: below any noise level
        // of interest.
        "quality.max_depth=8",
        fmt::format("quality.samples_per_axis={}", (kRaysPerAxis + oversampling - 1) / oversampling),
        "quality.contribution_threshold=0.0001",
        // Also scatters rays within their pixels, so that averaged frames do not share a grid.
        "quality.visibility=rays",
        "quality.sun_disk=true",
        "quality.facets_behind_diffuse=0",
        // Unused; at its default, so that references do not depend on it.
        fmt::format("quality.probe_directions={}", RenderQuality{}.probe_directions),
        fmt::format("quality.probes={}", RenderQuality{}.probes),
        fmt::format("quality.source_step_deg={}", RenderQuality{}.source_step_rad / kDegree_rad),
        "quality.lod_error_px=0",
        "quality.watertight=true",
        "quality.rays_across=512",
        "quality.point_samples=256",
        "quality.psf=fft",
        "quality.motion=exact",
        "quality.motion_error_px=0.1",
        fmt::format("quality.guard_px={}", guard_px),
        fmt::format("quality.oversampling={}", oversampling),
    };
    const std::size_t bins = s.spectrum_edges_um.size() - 1;
    const std::size_t most = static_cast<std::size_t>(kMaxBins) / bins * bins;
    if (most > bins) out.push_back(edges_override(regrouped_edges_um(s.spectrum_edges_um, most)));
    if (s.terrain) out.emplace_back("terrain.edge_px=1");
    return out;
}

std::vector<double> regrouped_edges_um(const std::vector<double>& edges_um, std::size_t bins) {
    const std::size_t own = edges_um.size() - 1;
    std::vector<double> out;
    if (bins <= own) {
        for (std::size_t i = 0; i <= bins; ++i) out.push_back(edges_um[(2 * i * own + bins) / (2 * bins)]);
        return out;
    }
    const std::size_t parts = bins / own;
    for (std::size_t i = 0; i < own; ++i)
        for (std::size_t k = 0; k < parts; ++k)
            out.push_back(edges_um[i] + (edges_um[i + 1] - edges_um[i]) * static_cast<double>(k) /
                                            static_cast<double>(parts));
    out.push_back(edges_um.back());
    return out;
}

std::string quality_yaml(const ScenarioConfig& scenario) {
    QualityConfig quality = scenario.quality;
    const SectionField section = section_of(quality);
    std::string out;
    for (const Field& field : section.fields)
        out += fmt::format("{}: {}\n", field.key, value_text(section, field.key));
    return out;
}

}  // namespace hilcam
