#pragma once
// Counter-based random numbers: a pure function of (seed, frame, pixel, purpose). Frames do not depend on the
// number of threads, and any pixel of any frame can be computed again alone. Philox-4x32-10: Salmon, Moraes,
// Dror, Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC11, 2011.

#include <array>
#include <cstdint>

namespace hilcam {

// The purpose that a number is drawn for. Each purpose is an independent stream. Its value is part of what
// makes frames reproducible: never reuse one.
enum class RandomPurpose : std::uint32_t {
    kSensorNoise = 1,  // word 0: shot noise, word 1: read noise
    kPathSample = 2,   // light paths; index: sample and depth
    // Fixed pattern of a pixel; index 0: gain, offset, dark current, kind; 1: excess dark current of a hot
    // pixel.
    kFixedPattern = 3,
    kRowPattern = 4,   // pattern of a row (index 0) or column (index 1)
    kConverter = 5,    // error of a converter's steps
    kRowNoise = 6,     // noise of a row in one frame
    kFlicker = 7,      // index: octave
    kTelegraph = 8,    // state of a pixel; `frame` counts the draws
    kCosmicRay = 9,    // pixel: number of the particle's track
    kFault = 10,       // draws of an ordered fault; index: its kind
    kPixelPlace = 11,  // start of the sequence of ray places in a pixel (place_sequence.h)
    kPointing = 32,    // jitter of the camera's line of sight; pixel: sinusoid, index: axis
    kAttitude = 33,    // jitter of a thing's attitude; pixel: sinusoid, index: thing and axis
    kCrater =
        35,  // craters of seeded ground (render/ground); frame: cell, pixel: crater, index: octave and use
    kBoulder = 36,       // boulders, in the same way
    kDeviceClock = 40,   // a clock's oscillator (io/ptp/oscillator.h); frame: second
    kDelayRequest = 41,  // waits of a PTP slave; index: how many came before
    kCampaign = 34,      // cases of a campaign (emulator/campaign/draw_source.h); frame: case, index: attempt
};

struct RandomKey {
    std::uint64_t seed = 0;
    std::uint64_t frame = 0;
};

// Returns the seed of the index-th of several things that draw independently; index 0 has the seed itself.
// The step is 2^64 over the golden ratio, so no two are near each other (Knuth, The Art of Computer
// Programming 3, 6.4).
inline std::uint64_t seed_of_nth(std::uint64_t seed, std::uint64_t index) {
    return seed + index * 0x9E3779B97F4A7C15u;
}

// Returns four independent 32-bit words. `pixel` and `index` (bounce, sample, ...) are free counters.
inline std::array<std::uint32_t, 4> random_words(RandomKey key, RandomPurpose purpose, std::uint32_t pixel,
                                                 std::uint32_t index = 0) {
    // Key: seed. Counter: pixel, index + purpose, frame. index stays below 2^24, so that it does not reach
    // the purpose.
    std::array<std::uint32_t, 4> c = {pixel, (static_cast<std::uint32_t>(purpose) << 24) ^ index,
                                      static_cast<std::uint32_t>(key.frame),
                                      static_cast<std::uint32_t>(key.frame >> 32)};
    std::uint32_t k0 = static_cast<std::uint32_t>(key.seed);
    std::uint32_t k1 = static_cast<std::uint32_t>(key.seed >> 32);
    for (int round = 0; round < 10; ++round) {
        // Multipliers and Weyl increments from the paper's reference (Random123).
        const std::uint64_t p0 = std::uint64_t{0xD2511F53u} * c[0];
        const std::uint64_t p1 = std::uint64_t{0xCD9E8D57u} * c[2];
        c = {static_cast<std::uint32_t>(p1 >> 32) ^ c[1] ^ k0, static_cast<std::uint32_t>(p1),
             static_cast<std::uint32_t>(p0 >> 32) ^ c[3] ^ k1, static_cast<std::uint32_t>(p0)};
        k0 += 0x9E3779B9u;
        k1 += 0xBB67AE85u;
    }
    return c;
}

// Returns a number in (0, 1): the middle of one of 2^23 equal cells, so that neither 0 nor 1 can occur in
// single precision.
inline float uniform01(std::uint32_t word) {
    return (static_cast<float>(word >> 9) + 0.5f) * (1.0f / 8388608.0f);
}

}  // namespace hilcam
