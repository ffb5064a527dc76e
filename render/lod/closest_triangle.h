#pragma once
// Finds the triangle of a mesh that is nearest to a place, by a tree over all of them (Embree).

#include <cstdint>
#include <memory>
#include <optional>

#include "render/vocabulary/mesh.h"

namespace hilcam {

class ClosestTriangle {
  public:
    // The mesh outlives this. Owner thread.
    explicit ClosestTriangle(const Mesh& mesh);
    ~ClosestTriangle();

    struct Query {
        Vec3f place_m;
        Vec3f normal;  // only triangles that face the same half of space are found
        std::uint16_t surface;
        float radius_m;
    };
    struct Found {
        std::uint32_t triangle;
        float u, v;  // barycentric, of the second and the third corner
    };
    // Returns none where there is no such triangle within the radius; of equally near ones the first. Any
    // thread.
    std::optional<Found> find(const Query& query) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace hilcam
