#pragma once
// The normals of the parts of a mesh for which a triangle of a coarser level stands. A level is flat where
// the mesh is wrinkled, and wrinkles are seen by how they lean long before they are by their shape: so a
// level's triangle keeps up to four of their normals, each with its share of their area.
//
// The parts of the mesh belong to the triangle of the same surface that is nearest to them and faces as they
// do. Their normals are divided twice across the axis in which they scatter most, at their mean (as colours
// are by Wu, ACM Trans. Graphics 10(4), 1991), which keeps their mean and most of their scatter; what is
// left over within the four groups is kept as roughness. That parts shade each other is shading/normal_clusters.h's.

#include <array>
#include <cstdint>
#include <vector>

#include "render/vocabulary/mesh.h"

namespace hilcam {

class LodNormals {
  public:
    static constexpr std::size_t kMax = 4;
    struct Normal {
        Vec3f lean;   // added to the level's own normal there, before it is made a unit vector; body axes
        float share;  // share of the area of all; 0: there are no more
    };
    // alpha: GGX's, of how normals scatter about these.
    static LodNormals of(const std::array<Normal, kMax>& normals, float alpha);
    // Leans nowhere.
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
    // It leans as its own normals do.
    bool is_flat() const { return share_[1] == 0 && alpha_ == 0 && x_[0] == 0 && y_[0] == 0 && z_[0] == 0; }

    static constexpr float kLean = 16383, kAll = 255;  // units of a lean (2 at most), and of a share

  private:
    // In this order for shading/cluster_packet.cpp, which reads them as eight words.
    std::array<std::int16_t, kMax> x_{}, y_{}, z_{};
    std::array<std::uint8_t, kMax> share_{};
    float alpha_ = 0;
};
static_assert(sizeof(LodNormals) == 32);

// One for each triangle of the level. error_m: how far the level is from the mesh, about. Owner thread; some
// seconds per million triangles of the mesh.
std::vector<LodNormals> lod_normals_of(const Mesh& mesh, const Mesh& level, double error_m);

}  // namespace hilcam
