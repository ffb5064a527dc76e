#pragma once
// The knobs that `hilcam tradeoff` turns: the choices of a scenario that trade speed for accuracy, as a
// table.
//
// A value is what `--set` takes, so that it is read and checked as a user's would be, and can be handed back
// to one. Not here: single or double precision, which geometry decides (bodies and world in double, rays in
// single); `watertight` is the one choice of precision.

#include <filesystem>
#include <string>
#include <vector>

#include "emulator/scenario/app_config.h"

namespace hilcam {

struct KnobValue {
    std::string label;
    std::vector<std::string> overrides;  // KEY=VALUE; none: as the scenario has it
};

// The things on which a knob's effect hangs.
enum class KnobRole {
    kAlways,
    kPathModel,
    kDepth,    // idle where the path model is direct
    kBounces,  // likewise, and where there is but one surface
};

struct Knob {
    std::string name;
    KnobValue own;                  // the scenario's value
    std::vector<KnobValue> others;  // each differs from it
    KnobRole role = KnobRole::kAlways;
    const KnobValue& value(std::size_t choice) const { return choice == 0 ? own : others[choice - 1]; }
    std::size_t choices() const { return 1 + others.size(); }
};

// A scenario as the user named it.
struct ScenarioSource {
    std::filesystem::path file;
    std::vector<std::string> overrides;

    // Throws InputError.
    ScenarioConfig load(const std::vector<std::string>& more = {}) const;
};

// Joins overrides; of two values for a key the later one counts.
std::vector<std::string> joined_overrides(const std::vector<std::string>& first,
                                          const std::vector<std::string>& second);

// Those that the scenario has a use for: no level of detail without an object, no air without an atmosphere.
std::vector<Knob> knobs_of(const ScenarioSource& source);

// Puts knobs that do nothing beside the others' choices back to the scenario's own values: what differs in
// these alone is the same picture.
void reset_idle(const std::vector<Knob>& knobs, std::vector<std::size_t>& choices);

// The best that there is, as overrides: what errors are measured against.
std::vector<std::string> reference_overrides(const ScenarioConfig& scenario);

// Edges for the same range in `bins` bins: some of the given edges for fewer bins, parts of equal width of
// each bin for more. [um]
std::vector<double> regrouped_edges_um(const std::vector<double>& edges_um, std::size_t bins);

// A setting's quality section as a file that a scenario's `quality:` can name.
std::string quality_yaml(const ScenarioConfig& scenario);

}  // namespace hilcam
