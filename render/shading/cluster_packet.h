#pragma once
// Sunlight on sixteen clusters of one material side by side: how their parts lean, which share of the light falls on each, and
// how much of it they reflect. The clusters may be those of several shading points. Compiled for several widths of vectors that
// give the same results.

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
    // Inputs. Unit vectors, world axes; view, light: towards them.
    Vectors normal, view, light;
    Floats samples{};        // that see it
    Floats flat{};           // cosine of its plane to the light, where it stands for others; else zero
    Floats side{};           // 1; -1: seen from behind
    Floats over_half{};      // one over the length of view + light
    Floats alpha_squared{};  // square of its own lobe's alpha
    std::array<LodNormals, kSize> parts{};  // that it stands for
    // Out: the weight that each part has with its cosines to both, and for the cluster sums of them: the light that falls on it,
    // and what leaves below facets and by their lobe.
    std::array<Floats, kParts> weight, no, ni;
    Floats lit, below, lobe;

    std::size_t count = 0;
};
// facets: null where the material has none, nor then below and lobe a value. Loop, any thread.
void reflect_clusters(const Mat3f& world_from_body, const LobeAlbedo* facets, ClusterPacket& packet);

}  // namespace hilcam
