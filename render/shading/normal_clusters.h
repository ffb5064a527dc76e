#pragma once
// The normal clusters of what a pixel sees: parts with different normals, each of which reflects the Sun on
// its own. They come from joining many samples into one shading point and from levels of detail that flatten
// normals (lod/lod_normals.h). A curved surface, such as a tube as wide as the pixel, has several clusters in
// one triangle: they share its samples, and shadow rays treat them as one.

#include <span>

#include "render/shading/frame_context.h"
#include "render/shading/shading_point.h"

namespace hilcam {

// Memory for the clusters of all shading points in a tile. One thread at a time.
class NormalClusters {
  public:
    static constexpr std::size_t kTurns = 4;  // largest number of normals of a curved part

    void clear() { count_ = 0; }
    // Returns how many more calls of add() fit. A shading point's first part is stored only with its second.
    std::size_t room() const { return (kMax - count_) / (1 + kTurns); }

    // Adds a part to a shading point; `first` marks the point's own. Clusters are stored if there is more
    // than one, or if a level of detail has flattened the part, because the point's own lobe is then wider
    // than theirs. turns: normals that replace the part's one, each with an equal share of its samples;
    // empty: that one. Loop, any thread.
    void add(const FrameContext& frame, NormalCluster part, std::uint32_t triangle, bool first,
             std::span<const Vec3f> turns, ShadingPoint& point);

  private:
    static constexpr std::size_t kMax = 4096;
    std::array<NormalCluster, kMax> clusters_;
    std::size_t count_ = 0;

    void push(const NormalCluster& part, ShadingPoint& point);
};

// The light that a shading point's clusters reflect from a source of irradiance 1, times the point's
// throughput.
struct ClusterLight {
    static constexpr std::size_t kStarts = 4;
    Spectrum reflected;
    // The clusters that reflect most, in falling order, and how much, summed over the bins.
    std::array<const NormalCluster*, kStarts> brightest{};
    std::array<float, kStarts> share{};
    SubpixelMoments moments;  // where in the pixel the light of all clusters is

    bool none() const { return !(share[0] > 0); }
    void add(const NormalCluster& cluster, float light);
};
// A shading point with clusters, and light from one direction.
struct SunlitPoint {
    static constexpr std::size_t kMaxTogether = 128;  // largest number in one call
    const ShadingPoint* at;
    Vec3f dir;    // towards the light, unit
    float alpha;  // alpha of the clusters' own lobes
};
// Computes the light that shading points with clusters reflect, SunlitPoint::kMaxTogether at most. out: one
// for each point, newly constructed. Loop, any thread.
void lit_clusters(const FrameContext& frame, std::span<const SunlitPoint> points,
                  std::span<ClusterLight> out);

}  // namespace hilcam
