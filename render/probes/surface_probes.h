#pragma once
// Surface probes: places on an object's surface where light is kept from frame to frame (radiosity/irradiance_cache.h).
//
// Space is cut into cubes of one size. What lies in one cube, belongs to one surface of the mesh, is the same
// side of its triangles (so that the inside of a body thinner than a cube is no part of its outside), faces one
// of 54 ways (30 degrees wide) and has no gap of a quarter of a cube in it, along that way, is a cell. Light belongs to probes,
// which are the corners of the cubes: a probe stands for the cells of one kind that touch its corner, by a few points on them. A
// place between has its cube's eight corners, weighted linearly, so that light is continuous where the surface is.
// Corners that touch the same cells are one probe: a flat wall has one layer. Where something stands between a probe's
// points, there are two, for the places on either side of it (probe_division.h).
//
// Nothing here depends on how the mesh is triangulated, so every level of detail finds its light in the same
// probes. What is finer than a cube is blurred: the size follows from how many probes are wanted.

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
    std::size_t count = 0;  // 0: the place is closed in, no light comes there

    // The one with the greatest weight; count > 0.
    std::uint32_t nearest() const {
        std::size_t best = 0;
        for (std::size_t i = 1; i < count; ++i)
            if (weight[i] > weight[best]) best = i;
        return probe[best];
    }
};

// Points on the cells that a probe stands for, body axes, metres; just above the surface.
struct SurfaceProbe {
    static constexpr int kPoints = 4;
    std::array<Vec3f, kPoints> point_m;
    std::array<std::uint32_t, kPoints> normal;     // packed (surface.h): the shading normal on this side
    std::array<std::uint32_t, kPoints> geometric;  // packed: the triangle's, on this side
    std::uint32_t mean_normal = 0;                 // mean normal of the points, packed
    std::uint16_t surface = 0;
    std::uint16_t unused = 0;
    Vec3f color{1, 1,
                1};  // colour of the texture and of the mesh's corners about there, linear RGB; 1 without
};

// The shares of what a place just above a surface sees that are further away than each of two distances. Any thread.
struct OpenShares {
    float near, far;
};
using Openness = std::function<OpenShares(Vec3f point_m, Vec3f geometric_normal, float near_m, float far_m)>;

// A list for each probe of those that lie beside it on its surface.
struct ProbeNeighbours {
    std::vector<std::uint32_t> first;  // by probe, and one more: where its list begins
    std::vector<std::uint32_t> probe;  // the lists, each in the order of numbers, without the probe itself

    std::span<const std::uint32_t> of(std::size_t n) const {
        return std::span(probe).subspan(first[n], first[n + 1] - first[n]);
    }
    std::size_t bytes() const { return (first.size() + probe.size()) * sizeof(std::uint32_t); }
};

// Cells that a probe stands for, in order; unused places hold SurfaceProbes::kClosed.
using CellSet = std::array<std::uint32_t, 8>;
class ProbeMaker;

class SurfaceProbes {
  public:
    static constexpr std::uint32_t kClosed = ~std::uint32_t{0};

    SurfaceProbes() = default;
    // keeps: per surface of the mesh, whether light is cached on it. wanted: about so many probes (between half
    // and one and a half of that, small meshes apart). Owner thread, on oneTBB; the same on any number of
    // threads.
    SurfaceProbes(const Mesh& mesh, std::span<const std::uint8_t> keeps, std::size_t wanted,
                  const Openness& openness, const Sight& sight);

    // The probes of a cell's cube, each once, and which of them its corners are.
    struct Cell {
        static constexpr unsigned kNone = 8;
        std::array<std::uint32_t, 8> probe{};
        std::uint16_t count = 0;
        std::uint16_t divided = 0;      // a bit each: the probe is one of two
        std::uint32_t corners = 0;      // four bits each: x + 2 y + 4 z; kNone: closed
        float lowest = 0, highest = 0;  // height_of() what lies in it

        Cell() = default;
        // Takes the probes of its corners, in order.
        void take(const std::array<std::uint32_t, 8>& of_corner);
        unsigned corner(std::size_t i) const { return corners >> (4 * i) & 0xFu; }
        // Returns how far a height is outside of it, in cubes.
        float off(float height) const { return std::max({lowest - height, height - highest, 0.0f}); }
    };
    // A search for a place in body axes, in steps: each asks for the memory that the next one reads, so that
    // who looks up many places takes every step for all of them. Loop, any thread.
    struct Search {
        Vec3f at{};  // in cubes
        Cube cube{};
        std::uint64_t key = 0;
        const Cell* cell = nullptr;
    };
    Search begin(Vec3f point_m, const SurfaceSide& side) const;
    void open(Search& search) const;
    // False where there are no cells: the place is off every surface by more than a cube.
    bool finish(const Search& search, ProbeWeights& about) const;
    // All steps in one.
    bool find(Vec3f point_m, const SurfaceSide& side, ProbeWeights& about) const {
        Search search = begin(point_m, side);
        open(search);
        return finish(search, about);
    }

    const std::vector<SurfaceProbe>& probes() const { return probes_; }
    float cube_m() const { return cube_m_; }
    std::size_t bytes() const;
    // Returns which probes are corners of one cell with each. Owner thread.
    ProbeNeighbours neighbours() const;

    // Makes them the probes of a mesh so many times as large.
    void scale(float factor);
    // Renumbers: new_number[old], or kClosed for probes that go.
    void keep(std::span<const std::uint32_t> new_number);

    // Gives all its members to files (io/cache/transfer_cache.h).
    struct Slot {
        std::uint64_t key = kNone;
        std::uint32_t cell = 0;  // the first of its layers, in the order of their heights
        std::uint32_t layers = 0;
        static constexpr std::uint64_t kNone = ~std::uint64_t{0};
    };
    // Two probes in one's place; cells name the one that is not closed, or the first.
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
    // True when what was read fits together.
    bool is_whole() const;

  private:
    Vec3f corner_m_;
    float cube_m_ = 1;
    std::vector<Slot> slots_;  // open addressing; a power of two
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
