#include "emulator/tradeoff/tradeoff_combinations.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "emulator/tradeoff/pareto.h"

namespace hilcam {
namespace {

using Choices = std::vector<std::size_t>;

// Smallest changes that count: smaller ones come from the clock, or from the random light paths.
constexpr double kFaster = 0.03, kMoreAccurate = 0.05;
// Smallest gain between neighbours on the predicted front, where errors are guesses.
constexpr double kPredictedGain = 0.05;
constexpr std::size_t kMaxCandidates = 200'000;

// Returns the rms error of a setting, because squares add up, whereas percentiles hide the smaller of two
// errors behind the larger.
double error_of(const MeasuredSetting& s) { return s.errors.noise.rms; }

// The effect of a knob's value relative to the scenario's own.
struct KnobEffect {
    std::size_t choice = 0;
    double time_ratio = 1;
    double error_squared = 0;  // added to that of the own setting
};

double weight_of(const std::vector<KnobEffect>& effects, double own_error_squared) {
    double most = 0;
    for (const KnobEffect& e : effects)
        most =
            std::max(most, std::abs(std::log(e.time_ratio)) + std::abs(e.error_squared) / own_error_squared);
    return most;
}

// Returns the measured values of one knob that are on its own front. They always include the scenario's own,
// because the loss from another value may be invisible beside the scenario's other errors.
std::vector<KnobEffect> front_of_knob(std::size_t knob, const std::vector<MeasuredSetting>& settings) {
    const MeasuredSetting& own = settings.front();
    std::vector<TimedError> points;
    std::vector<KnobEffect> effects;
    for (const MeasuredSetting& s : settings) {
        const bool single = s.kind == MeasuredSetting::Kind::kSingle && s.choices[knob] != 0;
        const bool better = s.times.frame_ms < (1 - kFaster) * own.times.frame_ms ||
                            error_of(s) < (1 - kMoreAccurate) * error_of(own);
        if (&s != &own && !(single && better)) continue;
        points.push_back({s.times.frame_ms, error_of(s)});
        effects.push_back({s.choices[knob], s.times.frame_ms / own.times.frame_ms,
                           error_of(s) * error_of(s) - error_of(own) * error_of(own)});
    }
    std::vector<KnobEffect> front;
    for (const std::size_t i : pareto_front(points, kMoreAccurate)) front.push_back(effects[i]);
    const bool has_own =
        std::any_of(front.begin(), front.end(), [](const KnobEffect& e) { return e.choice == 0; });
    if (!has_own) front.push_back(KnobEffect{});
    return front;
}

TimedError predicted(const MeasuredSetting& own, const std::vector<std::vector<KnobEffect>>& fronts,
                     const Choices& place) {
    double time_ratio = 1, squared = error_of(own) * error_of(own);
    // A prediction never goes below this share of the known error.
    const double least = 0.0025 * squared;
    for (std::size_t k = 0; k < fronts.size(); ++k) {
        time_ratio *= fronts[k][place[k]].time_ratio;
        squared += fronts[k][place[k]].error_squared;
    }
    return {own.times.frame_ms * time_ratio, std::sqrt(std::max(squared, least))};
}

// Advances like a counter's digits; false after the last combination.
bool advance(Choices& place, const std::vector<std::vector<KnobEffect>>& fronts) {
    for (std::size_t k = 0; k < place.size(); ++k) {
        if (++place[k] < fronts[k].size()) return true;
        place[k] = 0;
    }
    return false;
}

// Keeps the knobs with the least effect at their own values, until the remaining combinations are few enough.
void limit_candidates(std::vector<std::vector<KnobEffect>>& fronts, double own_error_squared) {
    const auto candidates = [&] {
        double count = 1;
        for (const auto& front : fronts) count *= static_cast<double>(front.size());
        return count;
    };
    while (candidates() > static_cast<double>(kMaxCandidates)) {
        std::vector<KnobEffect>* least = nullptr;
        for (auto& front : fronts)
            if (front.size() > 1 &&
                (!least || weight_of(front, own_error_squared) < weight_of(*least, own_error_squared)))
                least = &front;
        *least = {KnobEffect{}};
    }
}

}  // namespace

std::vector<std::vector<std::size_t>> promising_combinations(const std::vector<Knob>& knobs,
                                                             const std::vector<MeasuredSetting>& settings,
                                                             std::size_t most) {
    const MeasuredSetting& own = settings.front();
    const double own_squared = std::max(error_of(own) * error_of(own), 1e-12);
    std::vector<std::vector<KnobEffect>> fronts;
    for (std::size_t k = 0; k < knobs.size(); ++k) fronts.push_back(front_of_knob(k, settings));
    limit_candidates(fronts, own_squared);

    std::set<Choices> seen;
    std::vector<Choices> candidates;
    std::vector<TimedError> promises;
    Choices place(fronts.size(), 0);
    do {
        Choices choices;
        for (std::size_t k = 0; k < fronts.size(); ++k) choices.push_back(fronts[k][place[k]].choice);
        reset_idle(knobs, choices);
        const auto changed =
            std::count_if(choices.begin(), choices.end(), [](std::size_t c) { return c != 0; });
        if (changed < 2 || !seen.insert(choices).second) continue;
        candidates.push_back(choices);
        promises.push_back(predicted(own, fronts, place));
    } while (advance(place, fronts));

    std::vector<Choices> out;
    for (const std::size_t i : by_fronts(promises, most, kPredictedGain)) out.push_back(candidates[i]);
    return out;
}

}  // namespace hilcam
