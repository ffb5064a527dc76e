#include "io/config/renamed_keys.h"

#include <algorithm>
#include <array>

namespace hilcam {
namespace {

// No present key is in the first column (Scenario.EarlierNamesAreKeysOfTodayByTheirNewOnesAlone).
constexpr std::array kRenamedKeys = {
    RenamedKey{"kept_directions", "probe_directions"},
    RenamedKey{"kept_nodes", "probes"},
    RenamedKey{"kept_step_deg", "source_step_deg"},
    RenamedKey{"kept_earth", "earth_impostor"},
    RenamedKey{"point_samples_least", "min_point_samples"},
    RenamedKey{"most_triangles", "max_triangles"},
    RenamedKey{"least_hz", "min_hz"},
    RenamedKey{"most_hz", "max_hz"},
};

constexpr std::string_view kSamplesForPasses =
    "each pixel is sampled alike: samples_per_axis says how often, and sun_disk: true scatters its rays";
constexpr std::array kRemovedKeys = {
    RemovedKey{"noise_budget", "samples_per_axis", "0", kSamplesForPasses},
    RemovedKey{"max_passes", "samples_per_axis", "", kSamplesForPasses},
    RemovedKey{"most_passes", "samples_per_axis", "", kSamplesForPasses},
};

struct RenamedValue {
    std::string_view key, was, now;
};
constexpr std::array kRenamedValues = {
    RenamedValue{"path_model", "kept", "cached"},
};

}  // namespace

const RemovedKey* removed_key(std::string_view key) {
    const auto* const found = std::find_if(kRemovedKeys.begin(), kRemovedKeys.end(),
                                           [&](const RemovedKey& row) { return row.was == key; });
    return found == kRemovedKeys.end() ? nullptr : found;
}

std::string_view renamed_key(std::string_view key) {
    const auto found = std::find_if(kRenamedKeys.begin(), kRenamedKeys.end(),
                                    [&](const RenamedKey& row) { return row.was == key; });
    return found == kRenamedKeys.end() ? std::string_view() : found->now;
}

std::string_view renamed_value(std::string_view key, std::string_view value) {
    const auto found =
        std::find_if(kRenamedValues.begin(), kRenamedValues.end(),
                     [&](const RenamedValue& row) { return row.key == key && row.was == value; });
    return found == kRenamedValues.end() ? std::string_view() : found->now;
}

}  // namespace hilcam
