#include "io/config/config_advice.h"

#include <algorithm>
#include <vector>

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

constexpr std::size_t kMostSlips = 3;

}  // namespace

std::string nearest_of(std::string_view word, std::span<const std::string> known) {
    const std::string* nearest = nullptr;
    std::size_t least = kMostSlips + 1;
    for (const std::string& candidate : known) {
        const std::size_t distance = edit_distance(word, candidate);
        if (distance < least) least = distance, nearest = &candidate;
    }
    return nearest ? *nearest : std::string();
}

std::string advice_for(std::string_view key, const Fields& known) {
    std::vector<std::string> keys;
    std::string list;
    for (const Field& field : known) {
        if (field.key != key && ends_in_unit(key) && ends_in_unit(field.key) && stem(field.key) == stem(key))
            return "; its unit here is another: " + field.key;
        keys.push_back(field.key);
        list += " " + field.key;
    }
    const std::string nearest = nearest_of(key, keys);
    return (nearest.empty() ? "" : "; nearest known key: " + nearest) + "; known keys:" + list;
}

}  // namespace hilcam
