#include "io/ptp/oscillator.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/vocabulary/random.h"

namespace hilcam {
namespace {

// Box and Muller, Ann. Math. Stat. 29, 1958.
double normal_of_second(std::uint64_t seed, std::int64_t second) {
    const auto words =
        random_words({seed, static_cast<std::uint64_t>(second)}, RandomPurpose::kDeviceClock, 0);
    const double radius = std::sqrt(-2 * std::log(static_cast<double>(uniform01(words[0]))));
    return radius * std::cos(2 * std::numbers::pi * static_cast<double>(uniform01(words[1])));
}

}  // namespace

double Oscillator::rate_in(std::int64_t second) {
    if (config_.wander > 0)
        while (second_ < second) walk_ += config_.wander * normal_of_second(config_.seed, ++second_);
    return std::clamp(config_.rate + walk_, -kMaxRate, kMaxRate);
}

}  // namespace hilcam
