#pragma once
// Makes a probe (surface_probes.h) from the cells around a cube's corner: some points on them, and two probes
// if a wall separates the points.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "render/probes/probe_cells.h"
#include "render/probes/surface_probes.h"
#include "render/scene/color_bands.h"

namespace hilcam {

// Returns the height of points above the surface [m]: as for rays in shading_point.cpp, plus the rounding of
// the triangles.
float points_above_m(const Mesh& mesh);

// A probe, or two, for the sides below and above a wall.
struct MadeProbe {
    SurfaceProbe probe, above;
    std::optional<ProbeDivision> division;
};

// Mesh, cells and sight must outlive this. Any thread.
class ProbeMaker {
  public:
    ProbeMaker(const Mesh& mesh, const CubeGrid& grid, std::span<const FoundCell> cells, const Sight& sight);

    // set: the cells that the probe represents. seed: the probe's own.
    MadeProbe make(const CellSet& set, std::uint64_t seed) const;

  private:
    const Mesh& mesh_;
    CubeGrid grid_;
    std::span<const FoundCell> cells_;
    const Sight& sight_;
    std::vector<MipTexture> pictures_;
    float above_m_;

    // The points of a probe's cells, and the same points raised above low obstacles.
    struct Candidates {
        std::vector<CellPoint> point;
        std::vector<double> area_m2;  // area that each represents
        std::vector<Vec3f> raised_m;
        Vec3f facing;
    };
    Candidates candidates(std::span<const std::uint32_t> cells) const;
    SurfaceProbe of_points(const Candidates& all, std::span<const std::size_t> here,
                           std::uint64_t seed) const;
    SurfaceProbe of_cells(std::span<const std::uint32_t> cells, std::uint64_t seed) const;
    void add(SurfaceProbe& probe, std::size_t i, const CellPoint& candidate, Vec3f& color) const;
    Vec3f color(const TriangleSpread& spread, Vec3f w, std::uint16_t surface) const;
};

}  // namespace hilcam
