#include "io/config/config_advice.h"

#include <algorithm>
#include <array>
#include <vector>

#include "io/config/config_keys.h"
#include "io/config/data_sheet_words.h"
#include "io/config/renamed_keys.h"
#include "render/vocabulary/plain_number.h"

namespace hilcam {
namespace {

// Levenshtein, Soviet Physics Doklady 10(8), 1966.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t change = diagonal + (a[i - 1] != b[j - 1] ? 1 : 0);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, change});
        }
    }
    return row[b.size()];
}

// The part before a unit suffix: "exposure" of "exposure_ms".
std::string_view stem(std::string_view key) { return key.substr(0, key.rfind('_')); }
// Units are short: "us" of "exposure_us", unlike "numbr" of "f_numbr".
bool ends_in_unit(std::string_view key) {
    const std::size_t at = key.rfind('_');
    return at != std::string_view::npos && key.size() - at - 1 <= 3;
}

bool same_but_for_unit(std::string_view a, std::string_view b) {
    return a == b || (ends_in_unit(a) && ends_in_unit(b) && stem(a) == stem(b));
}

constexpr std::size_t kMaxSlips = 3;
constexpr std::size_t kMaxPlaces = 3;

std::string joined(const std::vector<std::string>& words) {
    std::string out;
    for (const std::string& word : words) out += (out.empty() ? "" : ", ") + word;
    return out;
}

// Returns where "exposure_ms" or "exposure_us" could belong, such as "camera.exposure_ms": the least nested
// places.
std::vector<std::string> places_of(std::string_view key, const Fields& root) {
    std::vector<std::string> out;
    std::ptrdiff_t least_deep = 0;
    for (const std::string& place : config_keys(root)) {
        if (!same_but_for_unit(key, std::string_view(place).substr(place.rfind('.') + 1))) continue;
        const std::ptrdiff_t depth = std::count(place.begin(), place.end(), '.');
        if (!out.empty() && depth > least_deep) continue;
        if (depth < least_deep) out.clear();
        least_deep = depth;
        out.push_back(place);
    }
    return out;
}

bool has_key(const Fields& known, std::string_view key) {
    return std::any_of(known.begin(), known.end(), [&](const Field& f) { return f.key == key; });
}

// Returns the key for a word of a data sheet. Empty when it is no such word, when it is a key of ours
// elsewhere, or when this place does not hold a camera's keys.
std::string sheet_advice(std::string_view key, const Fields& known, const Fields& root) {
    const DataSheetWord* const word = data_sheet_word(key);
    const bool inside = has_key(known, "full_well_e"), outside = has_key(known, "camera");
    if (!word || (!inside && !outside)) return {};
    if (!inside && !places_of(key, root).empty()) return {};
    if (word->key.empty()) return "; " + std::string(word->how);
    const std::string_view here = inside ? word->key.substr(word->key.rfind('.') + 1) : word->key;
    return "; a data sheet's word? here it is " + std::string(here) + ": " + std::string(word->how);
}

}  // namespace

std::string nearest_of(std::string_view word, std::span<const std::string> known) {
    const std::string* nearest = nullptr;
    std::size_t least = kMaxSlips + 1;
    for (const std::string& candidate : known) {
        const std::size_t distance = edit_distance(word, candidate);
        if (distance < least) least = distance, nearest = &candidate;
    }
    return nearest ? *nearest : std::string();
}

std::string advice_for(std::string_view key, const Fields& known, const Fields& root) {
    if (const std::string_view now = renamed_key(key); !now.empty() && has_key(known, now))
        return "; it was renamed to " + std::string(now);
    if (const RemovedKey* const removed = removed_key(key); removed && has_key(known, removed->beside))
        return "; it was removed: " + std::string(removed->instead);
    std::vector<std::string> keys;
    std::string list;
    for (const Field& field : known) {
        if (field.key != key && same_but_for_unit(key, field.key))
            return "; its unit here is another: " + field.key;
        keys.push_back(field.key);
        list += " " + field.key;
    }
    if (std::string of_sheet = sheet_advice(key, known, root); !of_sheet.empty()) return of_sheet;
    const std::string nearest = nearest_of(key, keys);
    if (!nearest.empty()) return "; nearest known key: " + nearest + "; known keys:" + list;
    // In a section with commands, the options are the commands' own words.
    if (std::find(keys.begin(), keys.end(), "do") != keys.end())
        return "; an option of a command stands in its words, as do: 'joint --object 1 --joint 1 --angle-deg "
               "30'; known "
               "keys:" +
               list;
    const std::vector<std::string> places = places_of(key, root);
    // A word like `name` occurs in too many places to help.
    if (places.empty() || places.size() > kMaxPlaces) return "; known keys:" + list;
    return "; there is " + joined(places) + "; known keys here:" + list;
}

std::string key_advice(std::string_view whole_key, const Fields& root) {
    const std::size_t last = whole_key.rfind('.') + 1;
    const std::vector<std::string> keys = config_keys(root);
    // Returns the whole key of another word in the same section; empty when the section has no such key.
    const auto beside = [&](std::string_view word) {
        std::string whole = std::string(whole_key.substr(0, last)).append(word);
        return std::find(keys.begin(), keys.end(), whole) != keys.end() ? whole : std::string();
    };
    if (const std::string now = beside(renamed_key(whole_key.substr(last))); !now.empty())
        return "; it was renamed to " + now;
    if (const RemovedKey* const removed = removed_key(whole_key.substr(last));
        removed && !beside(removed->beside).empty())
        return "; it was removed: " + std::string(removed->instead);
    const std::string nearest = nearest_of(whole_key, keys);
    if (!nearest.empty()) return "; nearest: " + nearest;
    const std::vector<std::string> places = places_of(whole_key, root);
    if (places.empty() || places.size() > kMaxPlaces)
        return "; accepted: a key as `hilcam manual` prints it, as camera.shutter or objects.N.pose";
    return "; there is " + joined(places);
}

std::string unit_advice(std::string_view name, double found, const Range& range) {
    struct Slip {
        std::string_view ending, words;
        double per_found;
    };
    static constexpr std::array kSlips = {
        Slip{"_um", "in nanometres", 1e-3}, Slip{"_mm", "in metres", 1e3},
        Slip{"_ms", "in seconds", 1e3},     Slip{"_km", "in metres", 1e-3},
        Slip{"_nm", "in micrometres", 1e3}, Slip{"", "in percent", 1e-2},
    };
    for (const Slip& slip : kSlips) {
        const double meant = found * slip.per_found;
        // Only shares are given in percent.
        const bool fits =
            slip.ending.empty() ? range.least == 0 && range.most <= 1 : name.ends_with(slip.ending);
        if (fits && meant >= range.least && meant <= range.most && meant != 0)
            return "; " + std::string(slip.words) + "? here it would be " + plain(meant);
    }
    return {};
}

}  // namespace hilcam
