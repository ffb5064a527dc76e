#pragma once
// The exposure of one frame.

#include <cstdint>
#include <optional>
#include <vector>

#include "render/vocabulary/vec.h"

namespace hilcam {

// The renderer's rays in a pixel: n for a regular n x n grid, halved(n) for a grid with halves, or
// kScatteredRays for random places over the pixel.
using RayGrid = int;
inline constexpr RayGrid kScatteredRays = 0;
// A grid of n x n rays, n even, that records in which half of a pixel light falls (subpixel_light.h).
constexpr RayGrid halved(int n) { return -n; }
constexpr bool is_halved(RayGrid rays) { return rays < 0; }

// The sampling of the radiance image.
struct SensorSampling {
    int guard_px = 0;                    // border of the image on each side, in pixels of the detector
    RayGrid samples_per_axis = 1;        // rays in each pixel of the image
    int oversampling = 1;                // image pixels across one detector pixel
    std::vector<RayGrid> other_grids{};  // grids that single frames may use instead
    bool always_fft = false;             // true: uses the FFT pair even where a compact kernel would do
};

// One exposure.
struct Exposure {
    double exposure_s = 1e-3;
    double gain_db = 0;
    std::optional<double> black_level_dn{};     // default: the camera's
    std::int64_t binning_x = 0, binning_y = 0;  // 0: the camera's
    // Motion during the exposure. The picture moves as a whole with image_rate_px_s; points at infinity
    // (stars) move as the camera turns.
    Vec2d image_rate_px_s{};
    Vec3d camera_rate_rad_s{};          // about the camera's axes
    std::optional<RayGrid> ray_grid{};  // default: SensorSampling's; otherwise one of its other_grids
};

}  // namespace hilcam
