#pragma once
// Mixes the bits of a word: words that differ in one bit get results that differ in half of theirs. For hash
// tables and random choices.

#include <cstdint>

namespace hilcam {

// The finalizer of SplitMix64 (Steele, Lea & Flood, OOPSLA 2014).
inline std::uint64_t mixed(std::uint64_t x) {
    x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9u;
    x = (x ^ x >> 27) * 0x94D049BB133111EBu;
    return x ^ x >> 31;
}

}  // namespace hilcam
