#include "emulator/scenario/quality_ladder.h"

#include <algorithm>

#include "io/config/config_manual.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/overloaded.h"
#include "render/vocabulary/plain_number.h"

namespace hilcam {

Fields per_frame_fields(RenderQuality& quality) {
    Fields list = fields(quality);
    std::erase_if(list, [](const Field& field) { return !field.per_frame; });
    return list;
}

// The renderer's own keys, with their ranges and meanings.
Fields fields(QualityLevelConfig& l) {
    Fields list = per_frame_fields(l.values);
    for (Field& field : list) {
        bool& given = l.given[field.key];
        field = optional(std::move(field), given);
    }
    return list;
}

Fields fields(LoopConfig& l) {
    Fields list = {
        beside_frames(choice("prefer", l.prefer, {"throughput", "latency"},
                             "order of rendering and sensor. throughput: a frame is rendered while the "
                             "previous one is in the sensor; latency: one after the other, each with all "
                             "threads, and a late frame starts as soon as possible, with the newest pose")),
        beside_frames(
            flag("wait_for_light", l.wait_for_light,
                 "treatment of frames while tables that are not on disk are being made. false: frames are "
                 "sent at once, rendered by random paths, with the flag no_kept_light; true: frames wait. "
                 "Used in free_run and triggered with quality.path_model cached; lockstep, --frames, "
                 "--record, --replay and all other commands always wait")),
        or_word(number("frame_budget_ms", l.frame_budget_s, 1e-3, {0, 1e6},
                       "time budget of a frame (throughput: its longer stage); the governor lowers the "
                       "quality to meet it, and raises it again. auto: in `hilcam run` without --frames, the "
                       "time to the next exposure at the frame rate, which clients may change; triggered "
                       "frames have no limit. 0: no governor"),
                "auto", LoopConfig::kBudgetOfRate_s),
        or_word(sections("levels", l.levels,
                         "quality levels that the governor may choose, best first: mappings (or files) of "
                         "the keys that differ from `quality`; left out: the built-in levels. fixed: every "
                         "frame has `quality`, and the frame rate falls if necessary"),
                "fixed", l.levels_fixed),
    };
    list.push_back(beside_frames(section(
        "fail_on", l.fail_on,
        "bounds of `run` and `bench --soak`: when one is broken, the run goes on to its end, names it "
        "there and exits with status 1 (docs/program.md)")));
    for (Field& field : fields(l.real_time)) list.push_back(beside_frames(std::move(field)));
    return list;
}

void validate(const LoopConfig& l) {
    if (l.levels.size() >= kMaxLevels)
        throw refused("levels", std::to_string(l.levels.size()), "at most " + std::to_string(kMaxLevels - 1));
    if (l.levels_fixed && l.frame_budget_s > 0)
        throw KeyError("levels",
                       "found 'fixed' beside a frame_budget_ms of " + plain(1e3 * l.frame_budget_s) +
                           ", which needs a governor; accepted beside it: a list of levels, or nothing");
}

namespace {

// Copies the value of a key to the same key in another list.
void copy_value(const Field& from, const Field& to) {
    std::visit(
        [&]<class Target>(const Target& target) {
            if constexpr (OneOf<Target, NumberField, IntegerField, FlagField, TextField>)
                *target.value = *std::get<Target>(from.target).value;
            else
                HILCAM_CHECK(!"a key of this kind cannot change between frames");
        },
        to.target);
}

}  // namespace

RenderQuality applied(const RenderQuality& configured, const QualityLevelConfig& l) {
    QualityLevelConfig level = l;
    // A level cannot choose the buffer when the configured quality has none.
    if (!configured.uses_buffer()) level.given["visibility"] = false;
    RenderQuality q = configured;
    const Fields from = per_frame_fields(level.values), to = per_frame_fields(q);
    for (std::size_t i = 0; i < to.size(); ++i)
        if (level.given[to[i].key]) copy_value(from[i], to[i]);
    return q;
}

std::string difference(const RenderQuality& from, const RenderQuality& to) {
    RenderQuality before = from, after = to;
    const SectionField old{per_frame_fields(before), {}}, now{per_frame_fields(after), {}};
    std::string out;
    for (const Field& field : now.fields) {
        const std::string value = value_text(now, field.key);
        if (value != value_text(old, field.key))
            out.append(out.empty() ? "" : ", ").append(field.key).append(" ").append(value);
    }
    return out;
}

namespace {

// Upper limits on quality; settings that are worse stay.
struct Limits {
    std::int64_t samples_per_axis, max_depth;
    double contribution_threshold, lod_error_px;
    bool direct;
};

RenderQuality limited(const RenderQuality& from, const Limits& to) {
    RenderQuality q = from;
    q.samples_per_axis = std::min(q.samples_per_axis, to.samples_per_axis);
    q.buffer_samples = std::min<std::int64_t>(q.buffer_samples, 16);
    q.max_depth = std::min(q.max_depth, to.max_depth);
    q.contribution_threshold = std::max(q.contribution_threshold, to.contribution_threshold);
    q.lod_error_px = std::max(q.lod_error_px, to.lod_error_px);
    q.sun_disk = false;
    if (to.direct) q.path_model = "direct";
    return q;
}

// Nothing else makes a scene of ground alone faster, and rays would take longer.
std::vector<RenderQuality> levels_of_ground(RenderQuality quality) {
    if (quality.ground_step_px > 1) return {};
    quality.ground_step_px = 2;
    return {quality};
}

}  // namespace

std::vector<RenderQuality> built_in_levels(const RenderQuality& configured) {
    if (configured.sees_ground()) return levels_of_ground(configured);
    const Limits steps[] = {{2, 3, 0.005, 0.25, false},
                            {1, 2, 0.5, 0.5, false},
                            {1, 2, 0.5, 1, false},
                            {1, 1, 1, 1, false},
                            {1, 1, 1, 2, true}};
    std::vector<RenderQuality> levels;
    RenderQuality last = configured;
    for (const Limits& step : steps) {
        const RenderQuality next = limited(last, step);
        if (difference(last, next).empty()) continue;
        levels.push_back(next);
        last = next;
    }
    return levels;
}

RayGrid ray_grid_of(const RenderQuality& q) {
    if (q.scatters_rays()) return kScatteredRays;
    if (q.uses_buffer()) return q.pixel_samples().across();
    return static_cast<RayGrid>(q.samples_per_axis);
}

}  // namespace hilcam
