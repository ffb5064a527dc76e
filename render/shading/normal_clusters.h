#pragma once
// The parts of what the camera sees in a pixel that lean otherwise, for the Sun to be reflected by each of
// them: what a shading point of many samples has joined, and what a level of detail has flattened
// (lod/lod_normals.h). What is curved, a tube as wide as the pixel, has several normals in one triangle: clusters that
// share its samples, and of which shadows ask as of one.

#include <span>

#include "render/shading/frame_context.h"
#include "render/shading/shading_point.h"

namespace hilcam {

// Memory for the clusters of a tile's shading points. One thread at a time.
class NormalClusters {
  public:
    static constexpr std::size_t kTurns = 4;  // normals of a part at most

    void clear() { count_ = 0; }
    // Returns how many calls of add() have a place; a shading point's own part comes late.
    std::size_t room() const { return (kMax - count_) / (1 + kTurns); }

    // Adds a part to a shading point, whose own is the first. Clusters are made where there is more than one, and of
    // what a level has flattened: its own lobe is wider than theirs. turns: normals of the part in place of
    // its one, each of as many of its samples; empty: that one. Loop, any thread.
    void add(const FrameContext& frame, NormalCluster part, std::uint32_t triangle, bool first,
             std::span<const Vec3f> turns, ShadingPoint& point);

  private:
    static constexpr std::size_t kMax = 4096;
    std::array<NormalCluster, kMax> clusters_;
    std::size_t count_ = 0;

    void push(const NormalCluster& part, ShadingPoint& point);
};

// The light that the clusters of a shading point reflect from a source of irradiance 1, with the shading point's throughput.
struct ClusterLight {
    static constexpr std::size_t kStarts = 4;
    Spectrum reflected;
    // The clusters that reflect most, most first, and how much, over all bins together.
    std::array<const NormalCluster*, kStarts> brightest{};
    std::array<float, kStarts> share{};
    SubpixelMoments moments;  // the light of all clusters is there

    bool none() const { return !(share[0] > 0); }
    void add(const NormalCluster& cluster, float light);
};
// A shading point with clusters, for light from one direction.
struct SunlitPoint {
    static constexpr std::size_t kMaxTogether = 128;  // together
    const ShadingPoint* at;
    Vec3f dir;    // towards the light, unit
    float alpha;  // alpha of the clusters' own lobes
};
// Finds what the normal clusters of shading points reflect, SunlitPoint::kMax at most. out: one for each, as they are made.
// Loop, any thread.
void lit_clusters(const FrameContext& frame, std::span<const SunlitPoint> points,
                  std::span<ClusterLight> out);

}  // namespace hilcam
