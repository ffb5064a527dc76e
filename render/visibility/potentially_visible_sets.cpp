#include "render/visibility/potentially_visible_sets.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <utility>

#include "render/ground/cube_sphere.h"
#include "render/scene/coplanar_groups.h"
#include "render/visibility/visibility_buffer.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Cells of 11 degrees, because narrower ones have hardly fewer triangles. Each has pictures from nine
// directions, 5.6 degrees apart, with four times as many samples in each direction as those that the sets
// serve. On the generated satellite one sample in 10,000 meets a triangle that its set lacks.
constexpr int kFaceCells = 8;   // cells along a face of a cube
constexpr int kStepsOfRow = 2;  // steps between a cell's directions in a row
constexpr int kPicture_px = 512;
constexpr double kFinerPictures = 4;
// The pictures' camera is so far away that directions are parallel; at a fortieth of its distance they differ
// by 1.4 degrees.
constexpr double kFrom_radii = 1000, kMin_radii = 40;
constexpr int kViewCells = kCubeFaces * kFaceCells * kFaceCells;
// A byte for each triangle.
using Marks = std::vector<std::uint8_t>;
void add(const Marks& of, Marks& to) {
    std::transform(of.begin(), of.end(), to.begin(), to.begin(), std::bit_or<std::uint8_t>());
}

std::size_t cell_of(Vec3d dir) {
    const CubePoint point = cube_point(dir);
    const auto step = [](double at) {
        return std::clamp(static_cast<int>((at + 1) / 2 * kFaceCells), 0, kFaceCells - 1);
    };
    return static_cast<std::size_t>((point.face * kFaceCells + step(point.at.y)) * kFaceCells +
                                    step(point.at.x));
}
struct Cell {
    int face, across, down;
};
Cell cell_at(std::size_t number) {
    const int n = static_cast<int>(number);
    return {n / (kFaceCells * kFaceCells), n % kFaceCells, n / kFaceCells % kFaceCells};
}

// Takes pictures of a mesh from far away.
class Pictures {
  public:
    Pictures(const MeshView& mesh, double radius_m, std::span<const std::uint32_t> coplanar_groups)
        : shown_{0, {}, radius_m, mesh, {}, coplanar_groups},
          buffer_(geometry(), {1, mesh.vertices_m.size(), mesh.triangles.size()}) {}

    // Marks what is visible from a direction, unit.
    void mark_seen(Vec3d from, Marks& marks) {
        // Not along the body's axes: thin parts along a row of samples would be hit by all samples or by
        // none.
        const Vec3d up = std::abs(from.x) < 0.5 ? Vec3d{0.8, 0.5, 0.3} : Vec3d{0.3, 0.8, 0.5};
        if (!buffer_.place({kFrom_radii * shown_.radius_m * from, look_along(-1.0 * from, up)},
                           {&shown_, 1})) {
            // No room: a mesh of many large triangles, all of which count as visible.
            std::fill(marks.begin(), marks.end(), std::uint8_t{1});
            return;
        }
        buffer_.fill_all(tile_, [&](int, int) {
            std::uint32_t last = VisibilityTile::kNothing;
            for (const std::uint32_t id : tile_.id)
                if (id != std::exchange(last, id) && id != VisibilityTile::kNothing) marks[id] = 1;
        });
    }

  private:
    VisibilityBuffer::Shown shown_;
    VisibilityBuffer buffer_;
    VisibilityTile tile_;

    // The mesh's sphere fills the picture.
    static ImageGeometry geometry() {
        ImageGeometry out;
        out.width_px = out.height_px = kPicture_px;
        out.focal_length_px = 0.5 * kPicture_px * kFrom_radii;
        return out;
    }
};

// Returns, for each cell, what is visible from any of its directions. Neighbouring cells share the directions
// on their border.
std::vector<Marks> seen_by_cell(const MeshView& mesh, double radius_m,
                                std::span<const std::uint32_t> coplanar_groups) {
    // Each triangle by itself, except those that are not shown.
    std::vector<std::uint32_t> own(mesh.triangles.size());
    for (std::uint32_t i = 0; i < own.size(); ++i)
        own[i] = !coplanar_groups.empty() && coplanar_groups[i] == kNotShown ? kNotShown : i;
    constexpr int kRow = kFaceCells * kStepsOfRow + 1;
    const auto number = [](int face, int across, int down) {
        return static_cast<std::size_t>((face * kRow + down) * kRow + across);
    };
    const auto along = [](int step) { return 2.0 * step / (kRow - 1) - 1; };
    std::vector<Marks> seen(number(kCubeFaces, 0, 0), Marks(own.size()));
    tbb::parallel_for(tbb::blocked_range<int>(0, kCubeFaces * kRow, 4), [&](const auto& rows) {
        const auto pictures = std::make_unique<Pictures>(mesh, radius_m, own);
        for (int row = rows.begin(); row < rows.end(); ++row)
            for (int i = 0; i < kRow; ++i)
                pictures->mark_seen(cube_direction(row / kRow, {along(i), along(row % kRow)}),
                                    seen[number(row / kRow, i, row % kRow)]);
    });
    std::vector<Marks> out(kViewCells, Marks(own.size()));
    for (std::size_t cell = 0; cell < out.size(); ++cell) {
        const auto [face, across, down] = cell_at(cell);
        for (int j = 0; j <= kStepsOfRow; ++j)
            for (int i = 0; i <= kStepsOfRow; ++i)
                add(seen[number(face, across * kStepsOfRow + i, down * kStepsOfRow + j)], out[cell]);
    }
    return out;
}

PotentiallyVisibleSet set_of(const MeshView& mesh, std::span<const std::uint32_t> coplanar_groups,
                             const Marks& marks) {
    constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();
    PotentiallyVisibleSet out;
    std::vector<std::uint32_t> places(mesh.vertices_m.size(), kNone);
    for (std::uint32_t i = 0; i < marks.size(); ++i) {
        if (!marks[i]) continue;
        TriangleCorners corners = mesh.triangles[i];
        for (std::uint32_t& corner : corners) {
            std::uint32_t& place = places[corner];
            if (place == kNone)
                place = static_cast<std::uint32_t>(out.vertices_m.size()),
                out.vertices_m.push_back(mesh.vertices_m[corner]);
            corner = place;
        }
        out.triangles.push_back(corners);
        out.ids.push_back(coplanar_groups.empty() ? i : coplanar_groups[i]);
    }
    return out;
}

}  // namespace

PotentiallyVisibleSets::PotentiallyVisibleSets(const MeshView& mesh, double radius_m,
                                               std::span<const std::uint32_t> coplanar_groups)
    : radius_m_(radius_m), sets_(kViewCells) {
    const std::vector<Marks> seen = seen_by_cell(mesh, radius_m, coplanar_groups);
    tbb::parallel_for(std::size_t{0}, sets_.size(),
                      [&](std::size_t cell) { sets_[cell] = set_of(mesh, coplanar_groups, seen[cell]); });
}

bool PotentiallyVisibleSets::serves(double distance_m, double sample_rad) const {
    constexpr double kMax =
        kPicture_px * kVisibilitySamplesAcross / kFinerPictures;  // samples across the mesh
    return distance_m >= kMin_radii * radius_m_ && 2 * radius_m_ <= kMax * sample_rad * distance_m;
}

const PotentiallyVisibleSet& PotentiallyVisibleSets::from(Vec3d dir) const { return sets_[cell_of(dir)]; }

}  // namespace hilcam
