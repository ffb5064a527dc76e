#include "emulator/tradeoff/tradeoff.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <atomic>

#include "emulator/progress/progress.h"
#include "emulator/tradeoff/mean_errors.h"
#include "emulator/tradeoff/pareto.h"
#include "emulator/tradeoff/tradeoff_combinations.h"
#include "render/vocabulary/median.h"
#include "render/vocabulary/stopwatch.h"

namespace hilcam {
namespace {

using Log = std::function<void(const std::string&)>;
using Kind = MeasuredSetting::Kind;

// Times of one frame: in total, and for rendering [ms].
struct FrameTime {
    double frame_ms, render_ms;
};
FrameTime take_frame(StillCamera& camera, RandomKey key, const ElectronImage*& electrons) {
    const Stopwatch watch;
    camera.render(key);
    const double render_ms = watch.ms();
    electrons = &camera.expose();
    camera.digitise(key);
    return {watch.ms(), render_ms};
}

std::size_t single_changes(const Tradeoff& t) {
    std::size_t count = 0;
    for (const Knob& knob : t.knobs) count += knob.choices() - 1;
    return count;
}

class Sweep {
  public:
    Sweep(Tradeoff& out, const PictureJudge& judge, const TradeoffOptions& options, const Log& log)
        : out_(out),
          judge_(judge),
          options_(options),
          log_(log),
          planned_(1 + single_changes(out) + static_cast<std::size_t>(options.combinations)) {}

    void run() {
        const std::vector<std::size_t> own(out_.knobs.size(), 0);
        const Progress progress("settings", 1, [this] { return share_done(); });
        try_setting(Kind::kOwn, own);
        std::vector<std::vector<std::size_t>> singles;
        for (std::size_t k = 0; k < own.size(); ++k)
            for (std::size_t choice = 1; choice < out_.knobs[k].choices(); ++choice) {
                singles.push_back(own);
                singles.back()[k] = choice;
            }
        try_all(Kind::kSingle, singles);
        try_all(Kind::kCombination, promising_combinations(out_.knobs, out_.settings, options_.combinations));
    }

  private:
    double left_s() const { return options_.budget_s - watch_.seconds(); }

    void try_all(Kind kind, const std::vector<std::vector<std::size_t>>& list) {
        for (std::size_t i = 0; i < list.size(); ++i) {
            if (left_s() <= 0) {
                remark(fmt::format("{} of {} {} not measured: the budget of {:g} s was used up",
                                   list.size() - i, list.size(),
                                   kind == Kind::kSingle ? "single changes" : "combinations",
                                   options_.budget_s));
                return;
            }
            try_setting(kind, list[i]);
            ++tried_;
        }
    }
    // Returns the finished share, by settings or by the budget, whichever ends sooner.
    double share_done() const {
        return std::max(static_cast<double>(tried_) / static_cast<double>(planned_),
                        1 - left_s() / options_.budget_s);
    }

    // Leaves out an impossible setting with its reason, unless it is the scenario itself.
    void try_setting(Kind kind, const std::vector<std::size_t>& choices) {
        try {
            measure(kind, choices);
        } catch (const InputError& error) {
            if (kind == Kind::kOwn) throw;
            leave_out(choices, error.what());
        }
    }
    void leave_out(const std::vector<std::size_t>& choices, const std::string& reason) {
        remark(fmt::format("{} not measured: {}", name_of(choices), reason));
    }
    void remark(const std::string& text) {
        out_.remarks.push_back(text);
        log_(text);
    }
    std::string name_of(const std::vector<std::size_t>& choices) const {
        std::string name;
        for (std::size_t k = 0; k < choices.size(); ++k)
            if (choices[k] != 0)
                name += fmt::format("{}{} {}", name.empty() ? "" : ", ", out_.knobs[k].name,
                                    out_.knobs[k].value(choices[k]).label);
        return name.empty() ? "as the scenario has it" : name;
    }

    void measure(Kind kind, const std::vector<std::size_t>& choices) {
        const ScenarioConfig scenario = scenario_of(choices);
        StillCamera camera(scenario);
        const auto seed = static_cast<std::uint64_t>(scenario.seed);
        const ElectronImage* electrons = nullptr;
        const FrameTime warm = take_frame(camera, {seed, 0}, electrons);
        if (kind != Kind::kOwn && 1e-3 * warm.frame_ms * options_.runs > left_s())
            return leave_out(choices,
                             fmt::format("a frame takes {:.1f} s, the budget of {:g} s has {:.0f} s left",
                                         1e-3 * warm.frame_ms, options_.budget_s, std::max(0.0, left_s())));
        std::vector<double> frame_ms, render_ms;
        MeanErrors errors;
        for (int run = 1; run <= options_.runs; ++run) {
            const FrameTime time = take_frame(camera, {seed, static_cast<std::uint64_t>(run)}, electrons);
            frame_ms.push_back(time.frame_ms), render_ms.push_back(time.render_ms);
            errors.add(judge_.errors(*electrons));
        }
        const auto [least, most] = std::minmax_element(frame_ms.begin(), frame_ms.end());
        out_.settings.push_back(
            {kind, choices, {median(frame_ms), median(render_ms), *least, *most}, errors.mean(), false});
        log_(fmt::format("{:8.2f} ms  error {:.3f} sigma  {}", out_.settings.back().times.frame_ms,
                         out_.settings.back().error(), name_of(choices)));
    }
    ScenarioConfig scenario_of(const std::vector<std::size_t>& choices) const {
        std::vector<std::string> overrides = out_.overrides_of(choices);
        if (out_.scenario.terrain) overrides.emplace_back("terrain.wait=true");
        return out_.source.load(overrides);
    }

    Tradeoff& out_;
    const PictureJudge& judge_;
    const TradeoffOptions& options_;
    const Log& log_;
    Stopwatch watch_;
    std::size_t planned_;
    std::atomic<std::size_t> tried_{0};
};

}  // namespace

std::vector<std::string> Tradeoff::overrides_of(const std::vector<std::size_t>& choices) const {
    std::vector<std::string> out;
    for (std::size_t k = 0; k < choices.size(); ++k) {
        const std::vector<std::string>& more = knobs[k].value(choices[k]).overrides;
        out.insert(out.end(), more.begin(), more.end());
    }
    return out;
}

Tradeoff measure_tradeoff(const ScenarioSource& source, const TradeoffOptions& options, const Log& log) {
    Tradeoff out;
    out.source = source;
    out.scenario = source.load();
    out.knobs = knobs_of(source);
    out.reference_overrides = joined_overrides(reference_overrides(out.scenario), options.reference_set);
    out.frame_ms = options.frame_ms.value_or(1e3 / out.scenario.camera.frame_rate_hz);
    out.error_sigma = options.error_sigma;

    std::vector<std::string> overrides = out.reference_overrides;
    if (out.scenario.terrain) overrides.emplace_back("terrain.wait=true");
    log(
        fmt::format("first the reference, then {} single changes and up to {} combinations in {:g} s, the "
                    "reference not counted",
                    single_changes(out), options.combinations, options.budget_s));
    const PictureJudge judge = first_instant_judge(source.load(overrides), options.reference, log);
    out.reference_frames = judge.reference().frames;
    out.reference_s = judge.reference().seconds;
    out.reference_standard_error = judge.reference().standard_error;

    Sweep(out, judge, options, log).run();
    std::vector<TimedError> points;
    for (const MeasuredSetting& s : out.settings) points.push_back({s.times.frame_ms, s.error()});
    for (const std::size_t i : pareto_front(points)) out.settings[i].on_front = true;
    out.within_time = best_within_time(points, out.frame_ms);
    out.within_error = fastest_within_error(points, out.error_sigma);
    return out;
}

}  // namespace hilcam
