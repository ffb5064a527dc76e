#include "emulator/progress/progress_line.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "io/system/text_number.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {

double seconds_between_lines(const char* text) {
    constexpr double kUsual_s = 30, kMin_s = 0.1, kMax_s = 1e6;
    if (text == nullptr) return kUsual_s;
    const std::optional<double> seconds = number_of(text);
    if (!seconds || !(*seconds >= 0)) return kUsual_s;
    return *seconds == 0 ? 0 : std::clamp(*seconds, kMin_s, kMax_s);
}

std::string duration_text(double seconds) {
    const auto s = static_cast<long long>(std::ceil(std::clamp(seconds, 0.0, 1e9)));
    if (s < 60) return fmt::format("{} s", s);
    if (s < 3600)
        return s % 60 == 0 ? fmt::format("{} min", s / 60) : fmt::format("{} min {} s", s / 60, s % 60);
    return fmt::format("{} h {} min", s / 3600, s % 3600 / 60);
}

std::optional<double> left_s(const ProgressItem& item) {
    constexpr double kMinTime_s = 1, kMinFraction = 0.01;
    if (!item.fraction || item.elapsed_s < kMinTime_s || *item.fraction < kMinFraction) return {};
    return item.elapsed_s * (1 - *item.fraction) / *item.fraction;
}

std::string progress_text(const std::vector<ProgressItem>& items, std::size_t max_columns) {
    // Work that has hardly begun has no count yet; "0 %" would look as if it stood still.
    const auto named = [](const ProgressItem& item) {
        const double percent = std::floor(100 * item.fraction.value_or(0));
        return percent >= 1 ? fmt::format("{} {:.0f} %", item.what, percent) : item.what;
    };
    const ProgressItem& first = items.front();
    std::string text = fmt::format("{}, {}", named(first), duration_text(first.elapsed_s));
    if (const auto left = left_s(first)) text += fmt::format(", about {} left", duration_text(*left));
    if (items.size() > 1) text += ": " + named(items.back());
    // Names may contain any bytes. A byte takes at most one column.
    text = harmless(text);
    if (text.size() > max_columns) text = harmless(text.substr(0, max_columns));
    return text;
}

}  // namespace hilcam
