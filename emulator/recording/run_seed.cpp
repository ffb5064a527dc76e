#include "emulator/recording/run_seed.h"

#include <sys/random.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>

#include "emulator/recording/recording_reader.h"
#include "emulator/scenario/scenario_listing.h"
#include "io/system/text_number.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

std::uint64_t drawn_bits() {
    std::uint64_t bits = 0;
    if (getentropy(&bits, sizeof bits) != 0)
        throw DeviceError(std::string("no random numbers from the kernel: ") + std::strerror(errno));
    return bits;
}

// Below 2^52, so that the seed is in the key's range and a whole number for readers of JSON.
std::int64_t drawn_seed() { return static_cast<std::int64_t>(drawn_bits() >> 12); }

std::optional<std::int64_t> recorded_seed(const std::filesystem::path& recording) {
    const std::string text = listed_value(RecordingReader(recording).header().scenario, "seed");
    const auto seed = parsed_as<std::int64_t>(text);
    return seed && *seed >= 0 ? seed : std::nullopt;
}

}  // namespace

std::string drawn_run_id() {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(drawn_bits()));
    return text;
}

std::string settle_seed(ScenarioConfig& scenario, const std::filesystem::path& replayed) {
    if (scenario.has_seed) return {};
    scenario.has_seed = true;
    if (!replayed.empty()) {
        if (const auto seed = recorded_seed(replayed)) {
            scenario.seed = *seed;
            return "seed " + std::to_string(*seed) + ", the recording's";
        }
    }
    scenario.seed = drawn_seed();
    return "seed " + std::to_string(scenario.seed) +
           ", drawn for this run; with --set seed=" + std::to_string(scenario.seed) +
           " its noise comes again";
}

}  // namespace hilcam
