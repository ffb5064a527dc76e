#include "emulator/tradeoff/tradeoff_ladder.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "emulator/scenario/quality_ladder.h"
#include "emulator/tradeoff/pareto.h"

namespace hilcam {
namespace {

constexpr std::string_view kQuality = "quality.";

bool may_change_between_frames(const std::vector<std::string>& overrides) {
    RenderQuality quality;
    const Fields may = per_frame_fields(quality);
    return std::all_of(overrides.begin(), overrides.end(), [&](std::string_view text) {
        return text.starts_with(kQuality) && std::any_of(may.begin(), may.end(), [&](const Field& field) {
                   return text.substr(kQuality.size(), text.find('=') - kQuality.size()) == field.key;
               });
    });
}

// Returns indices of settings, best first, thinned out evenly to the largest number of levels.
std::vector<std::size_t> rungs(const Tradeoff& t) {
    const double own_ms = t.settings.front().times.frame_ms;
    std::vector<std::size_t> which;
    std::vector<TimedError> points;
    for (std::size_t i = 1; i < t.settings.size(); ++i) {
        const MeasuredSetting& s = t.settings[i];
        if (s.times.frame_ms >= own_ms || !may_change_between_frames(t.overrides_of(s.choices))) continue;
        which.push_back(i);
        points.push_back({s.times.frame_ms, s.error()});
    }
    // A step must gain at least a twentieth to be worth a change of the picture.
    const std::vector<std::size_t> front = pareto_front(points, 0.05);
    const std::size_t count = std::min(front.size(), kMaxLevels - 1);
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t rank = count > 1 ? i * (front.size() - 1) / (count - 1) : 0;
        out.push_back(which[front[front.size() - 1 - rank]]);
    }
    return out;
}

}  // namespace

std::string ladder_yaml(const Tradeoff& t) {
    std::string levels;
    for (const std::size_t i : rungs(t)) {
        const MeasuredSetting& s = t.settings[i];
        std::string changes;
        for (const std::string& text : t.overrides_of(s.choices)) {
            const std::size_t equals = text.find('=');
            changes +=
                fmt::format("{}{}: {}", changes.empty() ? "" : ", ",
                            text.substr(kQuality.size(), equals - kQuality.size()), text.substr(equals + 1));
        }
        levels += fmt::format("  - {{{}}}  # {:.2f} ms, error {:.3f} sigma\n", changes, s.times.frame_ms,
                              s.error());
    }
    if (levels.empty()) return {};
    return fmt::format(
        "# What the governor may lower the quality to. By hilcam tradeoff, for {}; its own quality: {:.2f} "
        "ms, error "
        "{:.3f} sigma.\nframe_budget_ms: {:g}\nlevels:\n{}",
        t.scenario.name, t.settings.front().times.frame_ms, t.settings.front().error(), t.frame_ms, levels);
}

}  // namespace hilcam
