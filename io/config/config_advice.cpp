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

}  // namespace

std::string advice_for(std::string_view key, const Fields& known) {
    const Field* nearest = nullptr;
    std::size_t least = std::string_view::npos;
    for (const Field& field : known) {
        if (field.key != key && ends_in_unit(key) && ends_in_unit(field.key) && stem(field.key) == stem(key))
            return "; its unit here is another: " + field.key;
        const std::size_t distance = edit_distance(key, field.key);
        if (distance < least) least = distance, nearest = &field;
    }
    std::string text;
    if (nearest && least <= 3) text = "; nearest known key: " + nearest->key;
    text += "; known keys:";
    for (const Field& field : known) text += " " + field.key;
    return text;
}

}  // namespace hilcam
