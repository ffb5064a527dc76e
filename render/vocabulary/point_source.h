#pragma once
// A thing smaller than a pixel: its light reaches the aperture from one direction.

#include <cstdint>

#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

struct PointSource {
    static constexpr std::uint32_t kSky = ~std::uint32_t{0};
    // The number of the first body; objects have smaller ones.
    static constexpr std::uint32_t kFirstBody = std::uint32_t{1} << 31;

    // Position in the sensor frame: the centre of pixel (0, 0) is (0.5, 0.5), the guard band is not counted;
    // may lie outside.
    Vec2f position_px;
    // The motion against the stars [px/s]; of the sky 0.
    Vec2f drift_px_s{};
    // The object or body it is part of; of the sky it stands still against the stars.
    std::uint32_t object = kSky;
    // Irradiance at the aperture [W m^-2 um^-1], per bin.
    Spectrum irradiance_w_m2_um;
};
static_assert(sizeof(PointSource) == 64);  // a line of a cache: there may be a hundred thousand

}  // namespace hilcam
