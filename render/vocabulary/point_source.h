#pragma once
// A source smaller than a pixel: its light reaches the aperture from one direction.

#include <cstdint>

#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

struct PointSource {
    static constexpr std::uint32_t kSky = ~std::uint32_t{0};
    // The number of the first body. Objects have smaller numbers.
    static constexpr std::uint32_t kFirstBody = std::uint32_t{1} << 31;

    // Position in the sensor frame: the centre of pixel (0, 0) is (0.5, 0.5), without the guard band. May be
    // outside the frame.
    Vec2f position_px;
    // Motion against the stars [px/s]; 0 for the sky itself.
    Vec2f drift_px_s{};
    // The object or body that it belongs to. kSky: it stands still against the stars.
    std::uint32_t object = kSky;
    // Irradiance at the aperture [W m^-2 um^-1], per bin.
    Spectrum irradiance_w_m2_um;
};
static_assert(sizeof(PointSource) == 64);  // one cache line: there may be a hundred thousand points

}  // namespace hilcam
