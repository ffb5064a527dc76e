#pragma once
// The visibility buffer's samples stand on a regular grid of 4 x 4 in each of its pixels: of sixteen places these have
// the least error.

#include <cstddef>
#include <cstdint>

namespace hilcam {

inline constexpr int kVisibilityTile_px = 16;       // edge
inline constexpr int kVisibilitySamplesAcross = 4;  // a pixel, and down it
inline constexpr int kVisibilitySamples = kVisibilitySamplesAcross * kVisibilitySamplesAcross;

// The samples of a pixel of the picture, a bit each: those of one pixel of the buffer, or of four (pixel_samples.h).
using SampleMask = std::uint64_t;
inline constexpr std::size_t kMaxVisibilitySamples = 64;

// Returns where samples lie in their pixel: sample i is at ((i % 4 + 0.5) / 4, (i / 4 + 0.5) / 4).
constexpr float sample_x(int sample) { return (static_cast<float>(sample % 4) + 0.5f) / 4; }
constexpr float sample_y(int sample) { return (static_cast<float>(sample / 4) + 0.5f) / 4; }

}  // namespace hilcam
