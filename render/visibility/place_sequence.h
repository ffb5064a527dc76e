#pragma once
// Places in the unit square that fill it evenly for any number of them: Sobol's (0, 2)-sequence. Of any 2^k
// places that start at a multiple of 2^k, each of the 2^k equal boxes of any shape contains one. One random
// word per axis for the whole sequence preserves that and makes each single place uniform: Kollig & Keller,
// CGF 21(3), 2002, who give the code for both.

#include <array>
#include <cstdint>

#include "render/vocabulary/random.h"

namespace hilcam {

// Returns the base-2 radical inverse of `index`.
inline std::uint32_t reversed_bits(std::uint32_t index) {
    std::uint32_t word = 0;
    for (std::uint32_t bit = 1u << 31; index != 0; index >>= 1, bit >>= 1)
        if (index & 1) word |= bit;
    return word;
}

// Sobol's second dimension: columns of Pascal's triangle modulo 2.
inline std::uint32_t sobol_word(std::uint32_t index) {
    std::uint32_t word = 0;
    for (std::uint32_t column = 1u << 31; index != 0; index >>= 1, column ^= column >> 1)
        if (index & 1) word ^= column;
    return word;
}

// Returns place `index` of the sequence that two random words select; both coordinates are in (0, 1).
inline std::array<float, 2> place_in_sequence(std::uint32_t index, std::uint32_t word_x,
                                              std::uint32_t word_y) {
    return {uniform01(reversed_bits(index) ^ word_x), uniform01(sobol_word(index) ^ word_y)};
}

// Fractional parts of multiples of these fill the square evenly, however few follow each other (powers of the
// plastic number: Roberts 2018, extremelearning.com.au).
inline constexpr float kPlasticAlong = 0.7548777f, kPlasticAbout = 0.5698403f;

}  // namespace hilcam
