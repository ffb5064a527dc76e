#pragma once
// How a mesh leans where a coarser level stands for it: the facets (level_facets.h) of each of the level's triangles, and of parts
// of it.
//
// Foil of a level is made of triangles that are some pixels long before the level is seen to be off. If all of a triangle leans
// alike, so to say, a glint in it is as wide as the triangle, and in its middle. So a triangle is divided, each of its sides into
// two, four or eight, as far as there are parts of the mesh for its cells, and a pixel looks at the cell in which it is, of those
// that are as large as itself (as a texture's mip map is read: Williams, SIGGRAPH 83).
//
// A part of the mesh belongs to the triangle of the same surface that is nearest to it and faces as it does.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/levels/level_facets.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

struct FacetMap {
    static constexpr std::uint32_t kMaxDepth = 3;
    struct Division {
        std::uint32_t first = 0;  // of its cells: four of depth 1, sixteen of depth 2, ...
        std::uint32_t depth = 0;  // sides are divided by two so many times
        float side_m = 0;         // the triangle's longest
    };
    std::vector<LevelFacets> whole;   // by triangle
    std::vector<Division> divisions;  // likewise
    std::vector<LevelFacets> cells;

    bool empty() const { return whole.empty(); }
    // True when nothing in the triangle leans otherwise than itself.
    bool is_flat(std::size_t triangle) const { return whole[triangle].is_flat(); }
    struct Place {
        std::uint32_t triangle;
        float u, v;  // barycentric, of the second and the third corner
    };
    // Returns the facets about a place, of what is about as wide. Loop, any thread.
    const LevelFacets& at(const Place& place, float width_m) const;
    // True when every division is one of this many triangles, and has its cells.
    bool is_whole(std::size_t triangles) const;
};

// error_m: how far the level is from the mesh, about. Owner thread; some seconds per million triangles of the mesh.
FacetMap facets_of(const Mesh& mesh, const Mesh& level, double error_m);

}  // namespace hilcam
