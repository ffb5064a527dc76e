#pragma once
// Surface probes: places on an object's surface where light is cached between frames
// (radiosity/irradiance_cache.h). See docs/rendering.md, "Cached light".
//
// Space is divided into cubes of one size. A cell is the part of a cube's content that belongs to one surface
// of the mesh and to one side of its triangles (so that the inside of a thin body is separate from its
// outside), faces one of 54 directions (30 degrees wide), and has no gap of a quarter of a cube along that
// direction.
//
// Probes belong to the corners of the cubes. A probe represents all cells of one kind that touch its corner,
// by a few points on them. A place between is interpolated linearly from the eight corners of its cube, so
// light is continuous on a continuous surface. Corners that touch the same cells share a probe, so a flat
// wall has one layer of them. If something stands between a probe's points, there are two probes, for the
// places on either side (probe_division.h).
//
// Nothing here depends on the mesh's triangulation, so every level of detail finds its light in the same
// probes. Details smaller than a cube are blurred; the cube's size follows from the wanted number of probes.

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "render/probes/probe_cell_key.h"
#include "render/probes/probe_division.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

// The probes about a place, with weights whose sum is 1.
struct ProbeWeights {
    std::array<std::uint32_t, 8> probe;
    std::array<float, 8> weight;
    std::size_t count = 0;  // 0: the place is enclosed, and no light reaches it

    // Returns the probe with the largest weight; count > 0.
    std::uint32_t nearest() const {
        std::size_t best = 0;
        for (std::size_t i = 1; i < count; ++i)
            if (weight[i] > weight[best]) best = i;
        return probe[best];
    }
};

// Points on the cells that a probe represents: body axes, metres, just above the surface.
struct SurfaceProbe {
    static constexpr int kPoints = 4;
    std::array<Vec3f, kPoints> point_m;
    std::array<std::uint32_t, kPoints> normal;     // packed (packed_normal.h): shading normal on this side
    std::array<std::uint32_t, kPoints> geometric;  // packed: the triangle's normal on this side
    std::uint32_t mean_normal = 0;                 // packed: mean normal of the points
    std::uint16_t surface = 0;
    std::uint16_t unused = 0;
    Vec3f color{1, 1, 1};  // colour of texture and vertices there, linear RGB; 1 without
};

// The shares of what a place just above a surface sees that are farther away than each of two distances. Any
// thread.
struct OpenShares {
    float near, far;
};
using Openness = std::function<OpenShares(Vec3f point_m, Vec3f geometric_normal, float near_m, float far_m)>;

// For each probe, a list of its neighbours on the surface.
struct ProbeNeighbours {
    std::vector<std::uint32_t> first;  // by probe, and one more: start of its list
    std::vector<std::uint32_t> probe;  // lists, each in rising order and without the probe itself

    std::span<const std::uint32_t> of(std::size_t n) const {
        return std::span(probe).subspan(first[n], first[n + 1] - first[n]);
    }
    std::size_t bytes() const { return (first.size() + probe.size()) * sizeof(std::uint32_t); }
};

// The cells that a probe represents, in order; unused entries are SurfaceProbes::kClosed.
using CellSet = std::array<std::uint32_t, 8>;
class ProbeMaker;

class SurfaceProbes {
  public:
    static constexpr std::uint32_t kClosed = ~std::uint32_t{0};

    SurfaceProbes() = default;
    // keeps: for each surface of the mesh, whether light is cached on it. wanted: approximate number of
    // probes (the result has half to one and a half times as many, except for small meshes). Owner thread,
    // runs on oneTBB; the result does not depend on the number of threads.
    SurfaceProbes(const Mesh& mesh, std::span<const std::uint8_t> keeps, std::size_t wanted,
                  const Openness& openness, const Sight& sight);

    // The probes of a cell's cube, each listed once, and which of them belongs to each corner.
    struct Cell {
        static constexpr unsigned kNone = 8;
        std::array<std::uint32_t, 8> probe{};
        std::uint16_t count = 0;
        std::uint16_t divided = 0;      // one bit per probe: it is one of two
        std::uint32_t corners = 0;      // four bits per corner x + 2 y + 4 z; kNone: closed
        float lowest = 0, highest = 0;  // range of height_of() for what is in it

        Cell() = default;
        // Sets the probes of its corners, in order.
        void take(const std::array<std::uint32_t, 8>& of_corner);
        unsigned corner(std::size_t i) const { return corners >> (4 * i) & 0xFu; }
        // Returns how far a height is outside of the cell, in cubes.
        float off(float height) const { return std::max({lowest - height, height - highest, 0.0f}); }
    };
    // The search for a place (body axes) in three steps. Each step prefetches the memory that the next one
    // reads, so a caller with many places does each step for all of them. Loop, any thread.
    struct Search {
        Vec3f at{};  // in cubes
        Cube cube{};
        std::uint64_t key = 0;
        const Cell* cell = nullptr;
    };
    Search begin(Vec3f point_m, const SurfaceSide& side) const;
    void open(Search& search) const;
    // Returns false if there are no cells: the place is more than a cube away from every surface.
    bool finish(const Search& search, ProbeWeights& about) const;
    // All steps in one call.
    bool find(Vec3f point_m, const SurfaceSide& side, ProbeWeights& about) const {
        Search search = begin(point_m, side);
        open(search);
        return finish(search, about);
    }

    const std::vector<SurfaceProbe>& probes() const { return probes_; }
    float cube_m() const { return cube_m_; }
    std::size_t bytes() const;
    // Returns, for each probe, the probes that are corners of a common cell. Owner thread.
    ProbeNeighbours neighbours() const;

    // Scales the probes for a mesh that is larger by this factor.
    void scale(float factor);
    // Renumbers the probes: new_number[old], or kClosed for those that are dropped.
    void keep(std::span<const std::uint32_t> new_number);

    // Lists all members for the cache file (io/cache/transfer_cache.h).
    struct Slot {
        std::uint64_t key = kNone;
        std::uint32_t cell = 0;  // first of its layers, which are sorted by height
        std::uint32_t layers = 0;
        static constexpr std::uint64_t kNone = ~std::uint64_t{0};
    };
    // Two probes in the place of one. Cells refer to them by the one that is not closed, or the first.
    struct Pair {
        ProbeDivision division;
        std::uint32_t below = kClosed, above = kClosed;
        std::uint32_t name() const { return below != kClosed ? below : above; }
    };
    template <class Archive>
    static void list(auto& self, Archive& archive) {
        archive(self.corner_m_), archive(self.cube_m_), archive(self.slots_), archive(self.cells_),
            archive(self.probes_), archive(self.pairs_);
    }
    // True when the data read from a file are consistent.
    bool is_whole() const;

  private:
    Vec3f corner_m_;
    float cube_m_ = 1;
    std::vector<Slot> slots_;  // open addressing; size is a power of two
    std::vector<Cell> cells_;
    std::vector<SurfaceProbe> probes_;
    std::vector<Pair> pairs_;  // by name

    void make_probes(std::span<const CellSet> sets, const ProbeMaker& maker);
    void take(const std::array<std::uint32_t, 8>& of_corner, Cell& cell) const;
    const Pair* pair(std::uint32_t probe) const;
    std::uint32_t on_side(const Pair& pair, Vec3f at) const;
    bool lies(std::uint32_t probe, const Pair& pair, bool above) const;
    const Slot* slot(std::uint64_t key) const;
    const Cell* cell(const Slot& slot, Vec3f at) const;
    void take_neighbour(Search& search) const;
    void index(std::span<const std::uint64_t> keys);
};

}  // namespace hilcam
