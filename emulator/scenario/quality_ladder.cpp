#include "emulator/scenario/quality_ladder.h"

#include <algorithm>
#include <map>

#include "io/system/plain_number.h"
#include "render/vocabulary/check.h"

namespace hilcam {

Fields fields(QualityLevelConfig& l) {
    const std::map<std::string, bool*> may_change = {
        {"samples_per_axis", &l.has_samples_per_axis},
        {"visibility", &l.has_visibility},
        {"path_model", &l.has_path_model},
        {"max_depth", &l.has_max_depth},
        {"contribution_threshold", &l.has_contribution_threshold},
        {"sun_disk", &l.has_sun_disk},
        {"lod_error_px", &l.has_lod_error_px},
        {"noise_budget", &l.has_noise_budget}};
    // The renderer's own keys, with their ranges and meanings.
    Fields list;
    for (const Field& field : fields(l.values))
        if (const auto found = may_change.find(field.key); found != may_change.end())
            list.push_back(optional(field, *found->second));
    return list;
}

Fields fields(LoopConfig& l) {
    Fields list = {
        beside_frames(choice(
            "prefer", l.prefer, {"throughput", "latency"},
            "throughput: a frame is rendered while the one before is sensed; latency: one after the other, "
            "each with all threads")),
        beside_frames(
            flag("wait_for_light", l.wait_for_light,
                 "false: frames come at once while tables that are not on disk are still being made; they "
                 "are rendered by random paths and have the flag no_kept_light. true: no frame comes before. "
                 "Counts for free_run and triggered with quality.path_model kept; lockstep, --frames, "
                 "--record, --replay and all other commands always wait")),
        number("frame_budget_ms", l.frame_budget_s, 1e-3, {0, 1e6},
               "time that a frame may take (with throughput: the longer of its two stages); the governor "
               "lowers the quality until it is kept, and raises it again; 0: no governor"),
        sections("levels", l.levels,
                 "levels of quality that the governor may choose, best first: mappings of what differs from "
                 "`quality` (or files with them); left out: the program's own"),
    };
    for (Field& field : fields(l.real_time)) list.push_back(beside_frames(std::move(field)));
    return list;
}

void validate(const LoopConfig& l) {
    if (l.levels.size() >= kMaxLevels)
        throw InputError("levels: found " + std::to_string(l.levels.size()) + "; accepted: at most " +
                         std::to_string(kMaxLevels - 1));
}

RenderQuality applied(const RenderQuality& configured, const QualityLevelConfig& l) {
    RenderQuality q = configured;
    if (l.has_samples_per_axis) q.samples_per_axis = l.values.samples_per_axis;
    // A buffer that the quality has not is not there to be chosen.
    if (l.has_visibility && configured.uses_buffer()) q.visibility = l.values.visibility;
    if (l.has_path_model) q.path_model = l.values.path_model;
    if (l.has_max_depth) q.max_depth = l.values.max_depth;
    if (l.has_contribution_threshold) q.contribution_threshold = l.values.contribution_threshold;
    if (l.has_sun_disk) q.sun_disk = l.values.sun_disk;
    if (l.has_lod_error_px) q.lod_error_px = l.values.lod_error_px;
    if (l.has_noise_budget) q.noise_budget = l.values.noise_budget;
    return q;
}

std::string difference(const RenderQuality& from, const RenderQuality& to) {
    std::string out;
    const auto tell = [&out](const char* key, const std::string& value) {
        out.append(out.empty() ? "" : ", ").append(key).append(" ").append(value);
    };
    const auto report_number = [&](const char* key, double before, double after) {
        if (before < after || after < before) tell(key, plain(after));
    };
    if (from.visibility != to.visibility) tell("visibility", to.visibility);
    if (from.path_model != to.path_model) tell("path_model", to.path_model);
    report_number("max_depth", static_cast<double>(from.max_depth), static_cast<double>(to.max_depth));
    report_number("samples_per_axis", static_cast<double>(from.samples_per_axis),
                  static_cast<double>(to.samples_per_axis));
    report_number("contribution_threshold", from.contribution_threshold, to.contribution_threshold);
    report_number("lod_error_px", from.lod_error_px, to.lod_error_px);
    report_number("noise_budget", from.noise_budget, to.noise_budget);
    if (from.sun_disk != to.sun_disk) tell("sun_disk", to.sun_disk ? "true" : "false");
    return out;
}

namespace {

// No better than these; what is worse already stays.
struct Limits {
    std::int64_t samples_per_axis, max_depth;
    double contribution_threshold, lod_error_px;
    double budget_factor;  // on the noise budget; 0: none any more
    bool direct;
    bool rays;
};

RenderQuality limited(const RenderQuality& from, const RenderQuality& configured, const Limits& to) {
    RenderQuality q = from;
    q.samples_per_axis = std::min(q.samples_per_axis, to.samples_per_axis);
    q.max_depth = std::min(q.max_depth, to.max_depth);
    q.contribution_threshold = std::max(q.contribution_threshold, to.contribution_threshold);
    q.lod_error_px = std::max(q.lod_error_px, to.lod_error_px);
    q.noise_budget = to.budget_factor * configured.noise_budget;
    q.sun_disk = false;
    if (to.direct) q.path_model = "direct";
    if (to.rays) q.visibility = "rays";
    return q;
}

}  // namespace

std::vector<RenderQuality> built_in_levels(const RenderQuality& configured) {
    const Limits steps[] = {{2, 3, 0.005, 0.25, 2, false, false}, {1, 2, 0.5, 0.5, 4, false, false},
                            {1, 2, 0.5, 1, 0, false, false},      {1, 1, 1, 1, 0, false, false},
                            {1, 1, 1, 2, 0, true, false},         {1, 1, 1, 2, 0, true, true}};
    std::vector<RenderQuality> levels;
    RenderQuality last = configured;
    for (const Limits& step : steps) {
        const RenderQuality next = limited(last, configured, step);
        if (difference(last, next).empty()) continue;
        levels.push_back(next);
        last = next;
    }
    return levels;
}

RayGrid ray_grid_of(const RenderQuality& q) {
    if (q.noise_budget > 0) return kScatteredRays;
    return static_cast<RayGrid>(q.uses_buffer() ? kVisibilitySamplesAcross : q.samples_per_axis);
}

}  // namespace hilcam
