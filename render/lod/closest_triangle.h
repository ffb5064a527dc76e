#pragma once
// Finds the triangle of a mesh nearest to a place, by a tree over all triangles (Embree).

#include <cstdint>
#include <memory>
#include <optional>

#include "render/vocabulary/mesh.h"

namespace hilcam {

class ClosestTriangle {
  public:
    // The mesh must outlive this. Owner thread.
    explicit ClosestTriangle(const Mesh& mesh);
    ~ClosestTriangle();

    struct Query {
        Vec3f place_m;
        Vec3f normal;  // only triangles that face the same half-space are found
        std::uint16_t surface;
        float radius_m;
    };
    struct Found {
        std::uint32_t triangle;
        float u, v;  // barycentric: second and third corner
    };
    // Returns the nearest triangle within the radius, the first of equally near ones; none if there is none.
    // Any thread.
    std::optional<Found> find(const Query& query) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace hilcam
