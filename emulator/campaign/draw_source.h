#pragma once
// Numbers between 0 and 1 (places) from which a campaign's cases are drawn. A place depends only on the
// campaign's seed, the case, the attempt and the dimension, so that any machine can make any single case
// again.
//
//   random      Philox (render/vocabulary/random.h), 52 bits
//   halton      radical inverses in the bases 2, 3, 5, ... (Halton, Numerische Mathematik 2, 1960); at most
//               24 dimensions, as those with large bases stay correlated for many cases
//   r_sequence  n times powers of the generalised golden ratio, modulo 1 (M. Roberts, "The unreasonable
//               effectiveness of quasirandom sequences", extremelearning.com.au, 2018)
//
// Both even sequences are shifted by a random number for each dimension, modulo 1, which makes every single
// place uniform (Cranley & Patterson, SIAM J. Numer. Anal. 13, 1976). Each further attempt at a case has
// another shift, so the sequence is even over first attempts alone.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace hilcam {

enum class DrawSequence { kRandom, kHalton, kRSequence };

// Places for the cases of one campaign, by case, attempt and dimension.
class DrawSource {
  public:
    static constexpr std::size_t kMaxHalton = 24;
    static constexpr std::uint32_t kMaxTries = 1'000'000;

    // dimensions: how many dimensions place() may be asked for.
    DrawSource(std::uint64_t seed, DrawSequence sequence, std::size_t dimensions);

    // Returns a place in (0, 1). number: case, from 1; attempt: from 0.
    double place(std::uint64_t number, std::uint32_t attempt, std::size_t dimension) const;
    // Returns a random place for a purpose that is not one of the dimensions, whatever the sequence.
    double lot(std::uint64_t number, std::uint32_t purpose) const;
    // Returns the seed of a case, below 2^52.
    std::int64_t seed_of_case(std::uint64_t number) const;

  private:
    std::uint64_t seed_;
    DrawSequence sequence_;
    std::vector<double> steps_;  // steps of the R sequence, by dimension
};

// Mirrors the digits of n in a base at the point.
double radical_inverse(std::uint64_t n, std::uint32_t base);

}  // namespace hilcam
