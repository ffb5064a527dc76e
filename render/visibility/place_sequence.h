#pragma once
// Places in the unit square that fill it evenly however many are taken: the (0, 2)-sequence of Sobol'. Of any
// 2^k places from a multiple of 2^k on, each of the 2^k equal boxes of any shape holds one. A random word for
// each axis, the same for the whole sequence, keeps that and makes every single place uniform: Kollig &
// Keller, CGF 21(3), 2002, who give both as code.

#include <array>
#include <cstdint>

#include "render/vocabulary/random.h"

namespace hilcam {

// The base-2 radical inverse of `index`.
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

// Place `index` of the sequence that two random words choose; both coordinates in (0, 1).
inline std::array<float, 2> place_in_sequence(std::uint32_t index, std::uint32_t word_x,
                                              std::uint32_t word_y) {
    return {uniform01(reversed_bits(index) ^ word_x), uniform01(sobol_word(index) ^ word_y)};
}

// Multiples of these, without their whole parts, fill the square evenly however few follow each other (powers of the plastic number:
// Roberts 2018, extremelearning.com.au).
inline constexpr float kPlasticAlong = 0.7548777f, kPlasticAbout = 0.5698403f;

}  // namespace hilcam
