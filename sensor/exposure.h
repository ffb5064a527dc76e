#pragma once
// An exposure says how one frame is taken.

#include <cstdint>
#include <optional>
#include <vector>

#include "render/vocabulary/vec.h"

namespace hilcam {

// The renderer's rays in a pixel: n for a regular n x n grid, halved(n) for one with halves, or all over its area, at
// random.
using RayGrid = int;
inline constexpr RayGrid kScatteredRays = 0;
// A grid of n x n, n even, of which it is known in which half of a pixel light falls (subpixel_light.h).
constexpr RayGrid halved(int n) { return -n; }
constexpr bool is_halved(RayGrid rays) { return rays < 0; }

// The sampling says how the radiance image was made.
struct SensorSampling {
    int guard_px = 0;                    // the image's border on each side, in pixels of the detector
    RayGrid samples_per_axis = 1;        // in each of its pixels
    int oversampling = 1;                // pixels of the radiance image across one of the detector
    std::vector<RayGrid> other_grids{};  // grids that single frames may have instead
    bool always_fft = false;             // no compact kernel in place of the FFT pair, even where one will do
};

// One exposure.
struct Exposure {
    double exposure_s = 1e-3;
    double gain_db = 0;
    std::optional<double> black_level_dn{};     // default the camera's
    std::int64_t binning_x = 0, binning_y = 0;  // 0: the camera's
    // Rates of motion during the exposure. The picture of what is not at infinity moves as a whole; points
    // (stars) as the camera turns.
    Vec2d image_rate_px_s{};
    Vec3d camera_rate_rad_s{};          // about the camera's axes
    std::optional<RayGrid> ray_grid{};  // default that of SensorSampling; else one of its others
};

}  // namespace hilcam
