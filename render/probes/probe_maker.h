#pragma once
// Makes probes (surface_probes.h) of the cells about a corner: some points on these, and two probes where a wall stands between
// the points.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "render/probes/probe_cells.h"
#include "render/probes/surface_probes.h"
#include "render/scene/color_bands.h"

namespace hilcam {

// Returns how far above the surface points are [m]: as rays leave it in shading_point.cpp, with room for the triangles' own
// rounding.
float points_above_m(const Mesh& mesh);

// A probe, or two, for the places below and above a wall.
struct MadeProbe {
    SurfaceProbe probe, above;
    std::optional<ProbeDivision> division;
};

// Mesh, cells and sight outlive it. Any thread.
class ProbeMaker {
  public:
    ProbeMaker(const Mesh& mesh, const CubeGrid& grid, std::span<const FoundCell> cells, const Sight& sight);

    // set: the cells that the probe stands for. seed: the probe's own.
    MadeProbe make(const CellSet& set, std::uint64_t seed) const;

  private:
    const Mesh& mesh_;
    CubeGrid grid_;
    std::span<const FoundCell> cells_;
    const Sight& sight_;
    std::vector<MipTexture> pictures_;
    float above_m_;

    // The points of a probe's cells, and places above them, higher than what is no wall.
    struct Candidates {
        std::vector<CellPoint> point;
        std::vector<double> area_m2;  // that each stands for
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
