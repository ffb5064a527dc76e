#include "emulator/clone/frame_names.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>
#include <vector>

#include "io/system/text_number.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

std::string lower(std::string_view word) {
    std::string out(word);
    std::transform(out.begin(), out.end(), out.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return out;
}

// Returns the number before a unit, if the word is that.
std::optional<double> number_before(std::string_view word, std::string_view unit) {
    if (!word.ends_with(unit) || word.size() == unit.size()) return std::nullopt;
    const std::optional<double> value = number_of(std::string(word.substr(0, word.size() - unit.size())));
    if (!value || !std::isfinite(*value)) return std::nullopt;
    return value;
}

std::optional<double> exposure_in(std::string_view word) {
    for (const auto& [unit, seconds] : {std::pair{"us", 1e-6}, {"ms", 1e-3}, {"s", 1.0}})
        if (const std::optional<double> value = number_before(word, unit); value && *value > 0)
            return *value * seconds;
    return std::nullopt;
}

std::optional<SeriesKind> kind_in(std::string_view word) {
    using Kind = SeriesKind;
    for (const auto& [name, kind] : {std::pair{"dark", Kind::kDark},
                                     {"bias", Kind::kDark},
                                     {"flat", Kind::kFlat},
                                     {"edge", Kind::kEdge},
                                     {"chessboard", Kind::kChessboard},
                                     {"lag", Kind::kLag}})
        if (word == name) return kind;
    return std::nullopt;
}

// Returns the inner corners of a chessboard, as in 9x6; empty when the word is not that.
std::vector<double> corners_in(std::string_view word) {
    const std::size_t x = word.find('x');
    if (x == std::string_view::npos) return {};
    std::vector<double> out;
    for (const std::string_view part : {word.substr(0, x), word.substr(x + 1)}) {
        const std::optional<double> value = number_of(std::string(part));
        if (!value || !(*value >= 3 && *value <= 100) || *value != std::floor(*value)) return {};
        out.push_back(*value);
    }
    return out;
}

class Words {
  public:
    explicit Words(std::string_view name) : name_(name) {}

    std::optional<SeriesConfig> read() {
        std::string_view rest = name_;
        while (!rest.empty()) {
            const std::size_t end = std::min(rest.find_first_of("_/"), rest.size());
            take(lower(rest.substr(0, end)));
            rest.remove_prefix(std::min(end + 1, rest.size()));
        }
        if (!has_kind_) return std::nullopt;
        return out_;
    }

  private:
    void take(const std::string& word) {
        if (const std::optional<SeriesKind> kind = kind_in(word)) {
            if (has_kind_ && out_.kind != *kind) refuse("two kinds of frames", "one of them");
            out_.kind = *kind, has_kind_ = true;
        } else if (const std::vector<double> corners = corners_in(word); !corners.empty()) {
            out_.corners = corners;
        } else if (const std::optional<double> s = exposure_in(word)) {
            if (out_.exposure_s > 0 && std::abs(out_.exposure_s / *s - 1) > 1e-9)
                refuse("two exposures", "one, as 20ms");
            out_.exposure_s = *s;
        } else if (const std::optional<double> c = number_before(word, "c"); c && *c >= -200 && *c <= 150) {
            out_.temperature_c = *c, out_.has_temperature_c = true;
        } else if (const std::optional<double> db = number_before(word, "db"); db && std::abs(*db) <= 60) {
            out_.gain_db = *db;
        } else if (word.starts_with("light")) {
            const std::optional<double> light = number_of(word.substr(5));
            if (!light || !(*light > 0 && *light <= 1e12))
                refuse(in_quotes(word), "a positive number, as light0.5");
            out_.light = *light;
        }
    }
    [[noreturn]] void refuse(const std::string& found, const std::string& accepted) const {
        throw InputError(harmless(name_) + ": found " + found + "; accepted: " + accepted);
    }

    std::string_view name_;
    SeriesConfig out_;
    bool has_kind_ = false;
};

}  // namespace

std::optional<SeriesConfig> settings_in_name(std::string_view name) { return Words(name).read(); }

}  // namespace hilcam
