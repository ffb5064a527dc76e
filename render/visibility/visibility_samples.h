#pragma once
// The samples of the visibility buffer: a regular grid of 4 x 4 in each of its pixels, which has the smallest
// error of sixteen places.

#include <cstddef>
#include <cstdint>

namespace hilcam {

inline constexpr int kVisibilityTile_px = 16;       // edge of a tile
inline constexpr int kVisibilitySamplesAcross = 4;  // in a pixel, across and down
inline constexpr int kVisibilitySamples = kVisibilitySamplesAcross * kVisibilitySamplesAcross;

// One bit for each sample of a pixel of the picture, which is one pixel of the buffer or four
// (pixel_samples.h).
using SampleMask = std::uint64_t;
inline constexpr std::size_t kMaxVisibilitySamples = 64;

// Returns the place of a sample in its pixel: sample i is at ((i % 4 + 0.5) / 4, (i / 4 + 0.5) / 4).
constexpr float sample_x(int sample) { return (static_cast<float>(sample % 4) + 0.5f) / 4; }
constexpr float sample_y(int sample) { return (static_cast<float>(sample / 4) + 0.5f) / 4; }

}  // namespace hilcam
