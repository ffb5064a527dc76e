#pragma once
// The interface of details finer than the maps: something that adds to the heights of places.

#include <algorithm>
#include <cmath>
#include <span>

#include "render/vocabulary/vec.h"

namespace hilcam {

// Places around a point of the body, usually the square grid of a tile, and their data.
struct GroundPatch {
    int side = 1;                   // places along an edge
    std::span<const Vec3d> places;  // unit normals of the ellipsoid, by row
    std::span<double> heights_m;    // heights of the maps, plus details added so far
    std::span<Vec3f> colors;        // factors on the reflectance; empty if not needed
    Vec3d middle;                   // unit vector amid the places
    double reach_rad = 0;           // angle from the middle to the farthest place
    double texel_m = 1;             // width of a texel; details of only a few texels are left out

    // The rows and columns that may contain places within an angle of a direction.
    struct Window {
        int x0, x1, y0, y1;  // first, and one beyond the last
    };
    Window window(Vec3d place, double within_rad) const {
        // A strongly curved or missing grid is processed as a whole.
        constexpr double kBent_rad = 0.02;
        if (side < 3 || reach_rad > kBent_rad) return {0, side, 0, side};
        const std::size_t i = places.size() / 2, row = static_cast<std::size_t>(side);
        const Vec3d right = 0.5 * (places[i + 1] - places[i - 1]),
                    up = 0.5 * (places[i + row] - places[i - row]);
        const double rr = dot(right, right), uu = dot(up, up), ru = dot(right, up), area2 = rr * uu - ru * ru;
        const Vec3d away = place - places[i];
        const double r = dot(away, right), u = dot(away, up);
        const double x = (r * uu - u * ru) / area2 + side / 2, y = (u * rr - r * ru) / area2 + side / 2;
        // The curvature of the grid, and one texel.
        const double more = 1 + 1.5 * reach_rad * side;
        const double dx = within_rad * std::sqrt(uu / area2) + more,
                     dy = within_rad * std::sqrt(rr / area2) + more;
        const auto bound = [&](double value) { return static_cast<int>(std::clamp(value, 0.0, 1.0 * side)); };
        return {bound(x - dx), bound(x + dx + 1), bound(y - dy), bound(y + dy + 1)};
    }
    // Calls f(index) for the places of a window.
    template <class F>
    void for_each(const Window& w, const F& f) const {
        for (int y = w.y0; y < w.y1; ++y)
            for (int x = w.x0; x < w.x1; ++x) f(static_cast<std::size_t>(y * side + x));
    }
};

class GroundDetail {
  public:
    // Waves of this many texels or more are smooth enough to be sampled at every fourth texel and
    // interpolated.
    static constexpr double kWideTexels = 32;

    virtual ~GroundDetail() = default;
    // Adds the details too narrow for add_wide(). Any thread.
    virtual void add(const GroundPatch& patch) const = 0;
    // Adds smooth waves of kWideTexels and more. Any thread.
    virtual void add_wide(const GroundPatch&) const {}
};

}  // namespace hilcam
