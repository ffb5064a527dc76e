#include "io/files/element_set.h"

#include "io/files/omm_file.h"
#include "io/files/text_lines.h"
#include "io/files/tle_file.h"
#include "io/system/input_file.h"
#include "render/vocabulary/time_system.h"

namespace hilcam {
namespace {

constexpr std::uintmax_t kMaxFileBytes = 128u << 20;

// The letters of Alpha-5 in order, from 10 on (Space-Track, "Alpha-5 Satellite Catalog Numbers").
constexpr std::string_view kAlpha5Letters = "ABCDEFGHJKLMNPQRSTUVWXYZ";

bool is_same_satellite(const ElementSet& set, const std::string& wanted, const std::optional<int>& number) {
    return set.satellite == wanted || set.name == wanted || set.designator == wanted ||
           (number && catalogue_number(set.satellite) == number);
}

}  // namespace

std::optional<int> catalogue_number(std::string_view text) {
    text = trimmed(text);
    int first = 0;
    if (text.size() == 5)
        if (const std::size_t letter = kAlpha5Letters.find(text[0]); letter != std::string_view::npos) {
            first = static_cast<int>(10 + letter) * 10'000;
            text.remove_prefix(1);
        }
    constexpr std::size_t kMaxNumberDigits = 9;  // the limit of the CCSDS's NORAD_CAT_ID
    if (text.empty() || text.size() > kMaxNumberDigits) return {};
    int number = 0;
    for (const char c : text) {
        if (c < '0' || c > '9') return {};
        number = 10 * number + (c - '0');
    }
    return first + number;
}

double days_since_1950(int year, int month, int day, double part_of_day) {
    const TimeTai first = *from_calendar({1950, 1, 1, 0, 0, 0}, TimeSystem::kTai);
    const TimeTai date = from_calendar({year, month, day, 0, 0, 0}, TimeSystem::kTai).value();
    constexpr double kDay_s = 86400;
    return static_cast<double>(date - first) * kSecondsPerNs / kDay_s + 1 + part_of_day;
}

std::string refusal_of_ephemeris_type(std::string_view type) {
    type = trimmed(type);
    // Distributed sets have 0; 2 is for SGP4 and 3 for SDP4, which are one theory here.
    if (type.empty() || type == "0" || type == "2" || type == "3") return {};
    const std::string_view theory = type == "1"   ? "SGP"
                                    : type == "4" ? "SGP4-XP"
                                    : type == "5" ? "SDP8"
                                    : type == "6" ? "SP"
                                                  : "unknown here";
    return "is of ephemeris type " + std::string(type) + " (" + std::string(theory) +
           "), which is no set for SGP4; accepted: type 0";
}

std::vector<ElementSet> read_element_sets(std::string_view text, const std::string& name,
                                          TleChecksum checksum) {
    const std::optional<OmmForm> form = omm_form_of(text);
    return form ? read_omm(text, name, *form) : read_tles(text, name, checksum);
}

std::vector<ElementSet> load_element_sets(const std::filesystem::path& file, TleChecksum checksum) {
    return read_element_sets(read_input_file(file, {kMaxFileBytes, "a file of element sets (TLE or OMM)"}),
                             file.string(), checksum);
}

const ElementSet& choose_element_set(const std::vector<ElementSet>& sets, const std::string& satellite,
                                     TimeTai time, const std::string& file) {
    const ElementSet *chosen = nullptr, *refused = nullptr;
    const std::optional<int> number = catalogue_number(satellite);
    for (const ElementSet& set : sets) {
        if (satellite.empty() && set.satellite != sets.front().satellite)
            throw InputError(file + ": has sets of several satellites, " + in_quotes(sets.front().satellite) +
                             " and " + in_quotes(set.satellite) + "; accepted: one of them by 'satellite'");
        if (!satellite.empty() && !is_same_satellite(set, satellite, number)) continue;
        if (!set.refusal.empty()) {
            refused = &set;
            continue;
        }
        const bool past = set.epoch <= time;
        if (!chosen || (past && (chosen->epoch > time || set.epoch > chosen->epoch)) ||
            (!past && chosen->epoch > time && set.epoch < chosen->epoch))
            chosen = &set;
    }
    if (!chosen && refused)
        throw InputError(refused->where + ": the set of satellite " + in_quotes(refused->satellite) + " " +
                         refused->refusal);
    if (!chosen)
        throw InputError(file + ": has no satellite " + in_quotes(satellite) +
                         "; accepted: a number or name as " + shortened(sets.front().satellite) +
                         (sets.front().name.empty() ? "" : " or " + shortened(sets.front().name)));
    return *chosen;
}

}  // namespace hilcam
