#pragma once
// Sunlight on sixteen normal clusters of one material at once: how the LOD normals of each are weighted, how
// much light falls on it, and how much it reflects. The clusters may belong to several shading points.
// Compiled for several vector widths, which give the same results.

#include <array>
#include <cstdint>

#include "render/brdf/facet_lobe.h"
#include "render/lod/lod_normals.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

struct alignas(64) ClusterPacket {
    static constexpr std::size_t kSize = 16, kParts = LodNormals::kMax;
    using Floats = std::array<float, kSize>;
    struct Vectors {
        Floats x{}, y{}, z{};
        void set(std::size_t i, Vec3f v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
    };
    // Inputs. Unit vectors in world axes; view and light point towards viewer and light.
    Vectors normal, view, light;
    Floats samples{};        // samples that see the cluster
    Floats flat{};           // cosine between its plane and the light if it has LOD normals; otherwise zero
    Floats side{};           // 1; -1: seen from behind
    Floats over_half{};      // one over the length of view + light
    Floats alpha_squared{};  // square of its lobe's alpha
    std::array<LodNormals, kSize> parts{};  // its LOD normals
    // Outputs. For each LOD normal: its weight, and its cosines to viewer and light. For the cluster, sums
    // over these: light that falls on it, light that leaves from below the facets, and light that the facet
    // lobe reflects.
    std::array<Floats, kParts> weight, no, ni;
    Floats lit, below, lobe;

    std::size_t count = 0;
};
// facets: null if the material has none; `below` and `lobe` are then undefined. Loop, any thread.
void reflect_clusters(const Mat3f& world_from_body, const LobeAlbedo* facets, ClusterPacket& packet);

}  // namespace hilcam
