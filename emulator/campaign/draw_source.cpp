#include "emulator/campaign/draw_source.h"

#include <array>
#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/random.h"

namespace hilcam {
namespace {

constexpr std::array<std::uint32_t, DrawSource::kMaxHalton> kPrimes = {
    2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59, 61, 67, 71, 73, 79, 83, 89};

// Returns the centre of one of 2^52 equal cells, so neither 0 nor 1.
double place_of(std::uint32_t high, std::uint32_t low) {
    const std::uint64_t bits = (std::uint64_t{high} << 32 | low) >> 12;
    return (static_cast<double>(bits) + 0.5) * 0x1p-52;
}

double drawn_place(RandomKey key, std::uint32_t stream, std::uint32_t index) {
    const auto words = random_words(key, RandomPurpose::kCampaign, stream, index);
    return place_of(words[0], words[1]);
}

// Streams: dimensions from 0, then other purposes, then seeds. The shift of a sequence uses case 0, as cases
// count from 1.
constexpr std::uint32_t kLots = 1u << 30, kSeeds = 1u << 31;

double within_one(double x) {
    const double part = x - std::floor(x);
    constexpr double kCell = 0x1p-53;
    return part < kCell ? kCell : part < 1 - kCell ? part : 1 - kCell;
}

}  // namespace

DrawSource::DrawSource(std::uint64_t seed, DrawSequence sequence, std::size_t dimensions)
    : seed_(seed), sequence_(sequence) {
    if (sequence == DrawSequence::kHalton && dimensions > kMaxHalton)
        throw refused("sequence", "halton for " + std::to_string(dimensions) + " numbers a case",
                      "at most " + std::to_string(kMaxHalton) + " with it; r_sequence or random for more");
    if (sequence != DrawSequence::kRSequence) return;
    // Finds the positive root of x^(d + 1) = x + 1 by iteration.
    const double power = 1.0 / (static_cast<double>(dimensions) + 1);
    double ratio = 2;
    for (int step = 0; step < 64; ++step) ratio = std::pow(1 + ratio, power);
    for (std::size_t d = 0; d < dimensions; ++d)
        steps_.push_back(std::pow(1 / ratio, static_cast<double>(d) + 1));
}

double DrawSource::place(std::uint64_t number, std::uint32_t attempt, std::size_t dimension) const {
    HILCAM_CHECK(attempt < kMaxTries);
    const auto stream = static_cast<std::uint32_t>(dimension);
    if (sequence_ == DrawSequence::kRandom) return drawn_place({seed_, number}, stream, attempt);
    const double turn = drawn_place({seed_, 0}, stream, attempt);
    if (sequence_ == DrawSequence::kHalton)
        return within_one(turn + radical_inverse(number, kPrimes[dimension]));
    return within_one(turn + static_cast<double>(number) * steps_[dimension]);
}

double DrawSource::lot(std::uint64_t number, std::uint32_t purpose) const {
    return drawn_place({seed_, number}, kLots, purpose);
}

std::int64_t DrawSource::seed_of_case(std::uint64_t number) const {
    const auto words = random_words({seed_, number}, RandomPurpose::kCampaign, kSeeds, 0);
    return static_cast<std::int64_t>((std::uint64_t{words[0]} << 32 | words[1]) >> 12);
}

double radical_inverse(std::uint64_t n, std::uint32_t base) {
    const double digit = 1.0 / base;
    double scale = digit, sum = 0;
    for (; n > 0; n /= base, scale *= digit) sum += scale * static_cast<double>(n % base);
    return sum;
}

}  // namespace hilcam
