#pragma once
// Flat parts of a mesh with parts of other surfaces on top, as distant cameras see them: a solar panel's
// cells and bars over the gaps between them.
//
// Gaps and bars become far thinner than a pixel long before the panel does. Samples then hit or miss them,
// and the panel shows moire. A coverage map replaces the panel by an image: each texel has the share that
// each surface fills, from the areas of the mesh's triangles. A pixel asks for the shares in its footprint (a
// box filter, like the detector's) and gets one shading point per surface, with that throughput. So nothing
// depends on chance, and no gap is lost.
//
// Approximations: everything is in the plane of the highest part. Surfaces hide what is below them as if seen
// from straight above. They shade it like long walls along the rectangle's sides, at a distance equal to the
// width of the gaps. Parts of one surface do not overlap. The filter's edges fall off over a texel, at most a
// third of a pixel if texels are that fine.

#include <array>
#include <cstdint>
#include <vector>

#include "render/lod/coverage_map_sums.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

class CoverageMap {
  public:
    static constexpr std::size_t kMaxLayers = CoverageTexels::kLayers;
    // The largest angle between triangles and the ground [rad]: 0.3 degrees.
    static constexpr float kMaxLean = 0.00524f;

    // The distance to which its parts may extend beyond it, because of rounding and levels of detail
    // [texels].
    static constexpr float kLoose = 0.1f;

    // Its surfaces, from the ground upwards.
    std::array<std::uint16_t, kMaxLayers> surface{};
    std::size_t layers = 0;
    // Body axes. The plane of its highest part, seen from the side of normal = across x down; a corner of the
    // rectangle; the sides (unit), and their lengths.
    Vec3f normal, corner_m, across, down;
    float width_m = 0, height_m = 0;
    float above_m = 0;  // height of that plane above the ground
    float upper_m = 0;  // mean height of what is on the ground
    float texel_m = 0;

    // A pixel on the map: its middle and the steps of one pixel [texels from the corner].
    struct Footprint {
        Vec2d middle;
        Vec2f per_x, per_y;
    };
    // A pixel's view of the map.
    struct Coverage {
        // The surfaces' shares of the map in the pixel; they add up to one, or are all zero.
        std::array<float, kMaxLayers> share{};
        std::array<Vec2f, kMaxLayers> place{};  // middle of each [px from the pixel's corner]
        float lit = 0;                          // share of the ground that light reaches past what is on it
        // The lean of what is on the ground against it, along across and down: a difference of unit normals.
        Vec2f lean{};
    };
    // way: how far a ray to the light moves along across and down while it rises by one, minus the same for
    // the viewer. Loop, any thread.
    Coverage coverage(const Footprint& pixel, Vec2f way) const;

    // True when a triangle may be part of the map: its surface is, and it is in the rectangle, on the ground
    // or above it. Owner thread.
    bool holds(std::uint16_t surface_there, const std::array<Vec3d, 3>& corners_m) const;
    // True when the ground is below a triangle of the rectangle: below its corners and its middle. Owner
    // thread.
    bool covers(const std::array<Vec3d, 3>& corners_m) const;

  private:
    friend class CoverageMapPainter;
    // Texels of one size, in groups of eight along a row. Cells are alike, so few groups differ: a panel has
    // about 5,000 kinds among 73,000, which stay in caches.
    struct Level {
        int columns = 0, rows = 0;
        std::vector<CoverageTexels> kinds;
        std::vector<std::uint32_t> eights;  // kind of each group, row by row

        std::uint32_t row_of_eights() const {
            constexpr auto kLanes = static_cast<std::uint32_t>(CoverageTexels::kLanes);
            return (static_cast<std::uint32_t>(columns) + kLanes - 1) / kLanes;
        }
        std::size_t eight(int number, int row) const {
            return static_cast<std::size_t>(row) * row_of_eights() + static_cast<std::size_t>(number);
        }
    };
    std::vector<Level> levels_;  // each with half the resolution of the one before

    struct Steps;
    CoverageWindow window(const Footprint& pixel, const Steps& steps, std::size_t level) const;
};

}  // namespace hilcam
