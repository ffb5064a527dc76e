#pragma once
// The knobs of `hilcam tradeoff`: a table of a scenario's choices between speed and accuracy.
//
// A value has the form that `--set` takes, so that it is read and checked like a user's input and can be
// shown to a user. Single or double precision is not a knob, because geometry decides it (bodies and world in
// double, rays in single); `watertight` is the one choice of precision.

#include <filesystem>
#include <string>
#include <vector>

#include "emulator/scenario/app_config.h"

namespace hilcam {

struct KnobValue {
    std::string label;
    std::vector<std::string> overrides;  // KEY=VALUE; empty: as in the scenario
};

// The condition under which a knob has an effect.
enum class KnobRole {
    kAlways,
    kPathModel,
    kDepth,    // no effect with the direct path model
    kBounces,  // no effect with the direct path model, or with a single surface
};

struct Knob {
    std::string name;
    KnobValue own;                  // the scenario's value
    std::vector<KnobValue> others;  // each differs from `own`
    KnobRole role = KnobRole::kAlways;
    const KnobValue& value(std::size_t choice) const { return choice == 0 ? own : others[choice - 1]; }
    std::size_t choices() const { return 1 + others.size(); }
};

// A scenario as the user specified it.
struct ScenarioSource {
    std::filesystem::path file;
    std::vector<std::string> overrides;

    // Throws InputError.
    ScenarioConfig load(const std::vector<std::string>& more = {}) const;
};

// Joins overrides. The later of two values for a key counts.
std::vector<std::string> joined_overrides(const std::vector<std::string>& first,
                                          const std::vector<std::string>& second);

// Returns the knobs that matter to the scenario: no level of detail without an object, no air without an
// atmosphere.
std::vector<Knob> knobs_of(const ScenarioSource& source);

// Resets knobs without effect beside the other choices to the scenario's own values. Settings that differ
// only in such knobs give the same picture.
void reset_idle(const std::vector<Knob>& knobs, std::vector<std::size_t>& choices);

// Returns the best available quality as overrides. Errors are measured against it.
std::vector<std::string> reference_overrides(const ScenarioConfig& scenario);

// Returns edges [um] that divide the same range into `bins` bins: a selection of the given edges for fewer
// bins, equal parts of each bin for more.
std::vector<double> regrouped_edges_um(const std::vector<double>& edges_um, std::size_t bins);

// Returns a setting's quality section as a file that a scenario's `quality:` can name.
std::string quality_yaml(const ScenarioConfig& scenario);

}  // namespace hilcam
