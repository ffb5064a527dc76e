#pragma once
// Flat parts of a mesh on which parts of other surfaces lie, as distant cameras see them: the cells of a solar panel with their
// bars, over the gaps between them.
//
// Gaps and bars are far thinner than a pixel long before a panel is. A sample meets one or passes it by, and the panel has a
// moire. A coverage map is an image of the panel instead, in which each texel knows what share of it each surface fills, by the
// areas of the mesh's own triangles. A pixel asks for the shares in what it covers (a box filter, as the detector has it), and
// has a shading point for each surface there with that throughput: nothing is found by chance, and no gap is ever lost.
//
// The approximation: all of it lies in the plane of the highest part. Surfaces hide what is below them as from straight above, and
// shade it as long walls along the rectangle's sides would that are as far apart as gaps are wide; parts of one surface do not overlap.
// The filter's sides fall off over a texel, a third of a pixel at most where there are such.

#include <array>
#include <cstdint>
#include <vector>

#include "render/lod/coverage_map_sums.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

class CoverageMap {
  public:
    static constexpr std::size_t kMaxLayers = CoverageTexels::kLayers;
    // The most that triangles lean against the ground [rad]: 0.3 degrees.
    static constexpr float kMaxLean = 0.00524f;

    // The most that its parts stand out of it, for what rounding and levels of detail move [texels].
    static constexpr float kLoose = 0.1f;

    // Its surfaces, from the ground upwards.
    std::array<std::uint16_t, kMaxLayers> surface{};
    std::size_t layers = 0;
    // Body axes: the plane of its highest part, seen from the side to which normal = across x down points; a corner of the
    // rectangle, the sides, unit, and their lengths.
    Vec3f normal, corner_m, across, down;
    float width_m = 0, height_m = 0;
    float above_m = 0;  // height of that plane above the ground
    float upper_m = 0;  // mean height of what lies on the ground
    float texel_m = 0;

    // A pixel on it: where its middle is, and how far a step of a pixel goes [texels from the corner].
    struct Footprint {
        Vec2d middle;
        Vec2f per_x, per_y;
    };
    // The surfaces that are seen in the pixel.
    struct Coverage {
        // Their shares of what there is of the coverage map, which add up to one, or are all zero.
        std::array<float, kMaxLayers> share{};
        std::array<Vec2f, kMaxLayers> place{};  // the middle of each [px from the pixel's corner]
        float lit = 0;                          // share of the ground that light reaches past what lies on it
        // The lean of what lies on the ground against it, along across and down: a difference of unit normals.
        Vec2f lean{};
    };
    // way: how far a ray to the light goes along across and down while it rises by one, less what one to the viewer goes. Loop, any
    // thread.
    Coverage coverage(const Footprint& pixel, Vec2f way) const;

    // True when a triangle may be part of it: its surface is, and it lies in the rectangle, on the ground or upon it. Owner thread.
    bool holds(std::uint16_t surface_there, const std::array<Vec3d, 3>& corners_m) const;
    // True when the ground is below a triangle of its rectangle: below its corners and its middle. Owner thread.
    bool covers(const std::array<Vec3d, 3>& corners_m) const;

  private:
    friend class CoverageMapPainter;
    // Texels of one size, in eights of a row. Cells are alike: a panel has some 5,000 kinds of eights among 73,000, which stay in
    // caches.
    struct Level {
        int columns = 0, rows = 0;
        std::vector<CoverageTexels> kinds;
        std::vector<std::uint32_t> eights;  // the kind of each, row by row

        std::uint32_t row_of_eights() const {
            constexpr auto kLanes = static_cast<std::uint32_t>(CoverageTexels::kLanes);
            return (static_cast<std::uint32_t>(columns) + kLanes - 1) / kLanes;
        }
        std::size_t eight(int number, int row) const {
            return static_cast<std::size_t>(row) * row_of_eights() + static_cast<std::size_t>(number);
        }
    };
    std::vector<Level> levels_;  // each half as fine as the one before

    struct Steps;
    CoverageWindow window(const Footprint& pixel, const Steps& steps, std::size_t level) const;
};

}  // namespace hilcam
