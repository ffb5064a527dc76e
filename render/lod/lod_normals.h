#pragma once
// The normals that a triangle of a coarser level represents. A level is flat where the mesh is wrinkled, and
// the normals of wrinkles are visible long before their shape is. So a level's triangle keeps up to four of
// their normals, each with its share of the area.
//
// Each part of the mesh belongs to the nearest triangle of the same surface that faces the same way. The
// normals are divided twice at their mean, across the axis along which they vary most (as Wu divides colours,
// ACM Trans. Graphics 10(4), 1991). That keeps their mean and most of their variance; the rest, within the
// four groups, is kept as roughness. shading/normal_clusters.h models how the parts shade each other.

#include <array>
#include <cstdint>
#include <vector>

#include "render/vocabulary/mesh.h"

namespace hilcam {

class LodNormals {
  public:
    static constexpr std::size_t kMax = 4;
    struct Normal {
        Vec3f lean;   // added to the level's own normal before normalisation; body axes
        float share;  // share of the total area; 0: there are no more
    };
    // alpha: GGX alpha of the variation about these normals.
    static LodNormals of(const std::array<Normal, kMax>& normals, float alpha);
    // Returns a single normal that equals the level's own.
    static LodNormals flat() { return of({Normal{{}, 1}}, 0); }

    using Floats = std::array<float, kMax>;
    struct Leans {
        Floats x, y, z;
    };
    Leans leans() const {
        Leans out;
        for (std::size_t i = 0; i < kMax; ++i) {
            out.x[i] = static_cast<float>(x_[i]) * (1 / kLean);
            out.y[i] = static_cast<float>(y_[i]) * (1 / kLean);
            out.z[i] = static_cast<float>(z_[i]) * (1 / kLean);
        }
        return out;
    }
    Floats shares() const {
        Floats out;
        for (std::size_t i = 0; i < kMax; ++i) out[i] = static_cast<float>(share_[i]) * (1 / kAll);
        return out;
    }
    float alpha() const { return alpha_; }
    // True when it equals flat().
    bool is_flat() const { return share_[1] == 0 && alpha_ == 0 && x_[0] == 0 && y_[0] == 0 && z_[0] == 0; }

    static constexpr float kLean = 16383, kAll = 255;  // units of a lean (at most 2), and of a share

  private:
    // The order matters: shading/cluster_packet.cpp reads the members as eight words.
    std::array<std::int16_t, kMax> x_{}, y_{}, z_{};
    std::array<std::uint8_t, kMax> share_{};
    float alpha_ = 0;
};
static_assert(sizeof(LodNormals) == 32);

// Returns one for each triangle of the level. error_m: approximate distance between level and mesh. Owner
// thread; some seconds per million triangles of the mesh.
std::vector<LodNormals> lod_normals_of(const Mesh& mesh, const Mesh& level, double error_m);

}  // namespace hilcam
