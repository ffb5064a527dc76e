#pragma once
// Samples pixels again until their error is small against the noise of the sensor that will look at them.
//
// A part of a tile is traced in passes. In each, every pixel that is still wanted gets the next n x n rays of
// its sequence (place_sequence.h), so that a pass alone is already an unbiased mean over the pixel, and
// passes fill one another's gaps. Of the passes' means, in electrons, each pixel keeps count, mean and sum of
// squared deviations (Welford, Technometrics 4(3), 1962). A pixel of k passes is wanted while
//     V / k > budget^2 averaged sigma^2,
// V the variance of one pass, sigma that of the sensor (pixel_noise.h). That is the error of independent
// passes; these are better at edges, so it is on the safe side.
//
// V is not taken from the pixel alone. Few samples often agree by chance - two at the same side of an edge,
// ten that all miss a glint - and who trusts them stops just where the error is largest (Dippe & Wold,
// SIGGRAPH 85; the bias of stopping by the samples themselves: Kirk & Arvo, SIGGRAPH 91). Neighbours see much
// the same light with other random numbers, so V is the greater one of the pixel's own variance and that
// pooled over 3 x 3 pixels (Rousselle, Knaus & Zwicker, ACM TOG 30(6), 2011, filter their error estimates
// likewise). After one pass there is no variance in time yet: then it is that among the 3 x 3 values, which
// is no less on the mean, as the picture's own differences add to it. What all nine miss stays unseen.
//
// Errors are those of sampling: pixel area, shadows of the disk, light paths. What a quality leaves out
// (depth, levels of detail) is no noise, and not in them. The lens's
// falloff is left out, which is on the safe side: it takes more of the error than of the noise.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/shading/path_model.h"
#include "render/vocabulary/pixel_noise.h"

namespace hilcam {

struct NoiseBudget {
    double share = 0;  // share of the sensor's noise; 0: none
    int max_passes = 1;
    PixelNoise noise;
};

// Scratch memory of one thread. One thread at a time; nothing is allocated after construction.
class AdaptiveSampler {
  public:
    AdaptiveSampler();

    // Traces the box, of at most PathModel::kMaxSamples rays a pass. Gives the mean radiance of its pixels,
    // row by row, until the next call. What comes out depends on frame, box, n and budget alone. Loop.
    std::span<const Spectrum> trace(const FrameContext& frame, const PixelBox& box, int samples_per_axis,
                                    const NoiseBudget& budget, PathModel& paths, TileStats& stats);

  private:
    static constexpr auto kMax = static_cast<std::size_t>(PathModel::kMaxSamples);

    NormalClusters clusters_;
    std::vector<Spectrum> pass_, mean_;
    // Mean and sum of squares of the passes' means [e-].
    std::array<float, kMax> mean_e_, squares_e2_;
    std::array<std::uint16_t, kMax> passes_;
    std::array<std::uint8_t, kMax> wanted_;
    int width_ = 0, height_ = 0;

    std::size_t pixels() const { return static_cast<std::size_t>(width_ * height_); }
    void begin(const PixelBox& box);
    void take_pass(float share, const PixelNoise& noise, int bins);
    bool choose(const NoiseBudget& budget);
    float pass_variance(int x, int y) const;
    void count(TileStats& stats) const;
};

}  // namespace hilcam
