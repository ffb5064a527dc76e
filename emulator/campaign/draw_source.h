#pragma once
// The places between 0 and 1 by which a campaign's cases are drawn: a pure function of the campaign's seed,
// the case, the try and the dimension, so that any case comes again alone, on any machine.
//
//   random      Philox (render/vocabulary/random.h), 52 bits
//   halton      radical inverses in the bases 2, 3, 5, ... (Halton, Numerische Mathematik 2, 1960); 24
//               dimensions at most, as those of large bases go together for long
//   r_sequence  n times powers of the generalised golden ratio, modulo 1 (M. Roberts, "The unreasonable
//               effectiveness of quasirandom sequences", extremelearning.com.au, 2018)
// Both even sequences are turned by a random number for each dimension, which makes every single place
// uniform (Cranley & Patterson, SIAM J. Numer. Anal. 13, 1976). A further try of a case has another turn: the
// sequence's places are those of the first tries.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace hilcam {

enum class DrawSequence { kRandom, kHalton, kRSequence };

// The dimensions that one part of a draw uses; each part has its own, whatever others use.
class DrawSource {
  public:
    static constexpr std::size_t kMaxHalton = 24;
    static constexpr std::uint32_t kMaxTries = 1'000'000;

    // dimensions: number of those that may be asked for.
    DrawSource(std::uint64_t seed, DrawSequence sequence, std::size_t dimensions);

    // Returns a place in (0, 1). number: of the case, from 1; attempt: from 0.
    double place(std::uint64_t number, std::uint32_t attempt, std::size_t dimension) const;
    // Returns a random place whatever the sequence, of a purpose of its own: for what is no dimension.
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
