#pragma once
// Gradient noise (Perlin, SIGGRAPH 02) of one octave at many places, compiled for several vector widths with
// the same bits. Any thread.

#include <cstdint>
#include <span>

#include "render/vocabulary/vec.h"

namespace hilcam {

// A wave of the relief: noise(scale * place + shift), times an amplitude.
struct ReliefWave {
    std::uint64_t seed = 0;
    int octave = 0;  // below 2^8
    double scale = 1;
    Vec3d shift;
    double amplitude_m = 1;
};
// Adds the wave to the heights of places. |scale * place + shift| must be below 2^51.
void add_wave(const ReliefWave& wave, std::span<const Vec3d> places, std::span<double> heights_m);

}  // namespace hilcam
