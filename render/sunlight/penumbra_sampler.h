#pragma once
// Shadows' edges on what the camera sees by the visibility buffer, as wide as the Sun's disk makes them.
//
// One ray to the middle of the Sun tells which shading points are lit, and one for all layers of a coverage map in a pixel. Where
// shading points of one kind that differ lie in pixels within kReach_px of each other, an edge passes: each of them asks again by
// four rays, and by sixteen where these differ, from places that its samples see to places of the disk. Of a shading point with
// clusters each ray stands for as much of its light, and begins at what its samples see of the cluster. A kind is a surface of an
// object, or more than one, where it faces the same way by and large: what lies in shadow behind an edge of the body is no edge
// of a shadow on what stands before it. The approximation: a shading point further off has its one ray, so penumbras wider than
// twice the reach keep a hard edge inside; and what fills no more than a 64th of a pixel has one, a 16th four.

#include <array>
#include <cstdint>

#include "render/shading/normal_clusters.h"
#include "render/shading/path_model.h"

namespace hilcam {

class SunSampler;

// Memory for the shading points of a tile. One thread at a time.
class PenumbraSampler {
  public:
    // light: what the shading point sends to the viewer, to its pixel, if all of it is in the Sun. At most
    // PathModel::kMaxShadingPoints. Loop, any thread.
    void add(const ShadingPoint& at, const Spectrum& light) {
        Asked& asked = next(at, light);
        asked.clusters[0] = nullptr, asked.shares = {1};
        asked.moments_of_all = at.moments;
        asked.first_m = at.start();
    }
    // The same of a shading point with clusters: its rays begin at these.
    void add(const ShadingPoint& at, const Spectrum& light, const ClusterLight& clusters) {
        Asked& asked = next(at, light);
        asked.clusters = clusters.brightest, asked.shares = clusters.share;
        asked.moments_of_all = clusters.moments;
        asked.first_m = clusters.brightest[0]->start_m;
    }
    // Adds the light of all of them to their pixels, as far as the Sun reaches them, and forgets them. Loop, any
    // thread.
    void add_light(Tile& tile, const SunSampler& sun);

  private:
    static constexpr int kReach_px = 1, kMaxRows = 32;
    static constexpr std::size_t kKinds = 16;
    // Rays of who asks again, and of those whose rays differ.
    static constexpr float kAgain = 4, kMax = 16;
    // Less of a pixel [samples of sixteen] has no more rays: half of it at most is in the wrong light, a 128th of the pixel, which
    // is a noise of a full well of 15,000 electrons; of small objects with many parts most shading points are such.
    static constexpr float kMinAgain = 0.25f, kMinMost = 1;
    struct Asked {
        const ShadingPoint* at;
        const Asked* like;  // the one whose first ray tells for it, too; null: it has its own
        Spectrum light;
        Vec3f first_m;  // start of the first ray
        // Those that have the most of the light, and how much; null: it has none.
        std::array<const NormalCluster*, ClusterLight::kStarts> clusters;
        std::array<float, ClusterLight::kStarts> shares;
        float lit, of;                   // rays that have got through, and that were asked
        SubpixelMoments moments_of_all;  // the light is there if no ray is held up
        SubpixelMoments moments;         // sum of those that have got through, one by one
        std::uint8_t kind;               // below kKinds
    };
    using Rows = std::array<std::uint32_t, kMaxRows>;  // a bit for each pixel
    // Pixels with a shading point of a kind that is lit, or dark.
    struct Answers {
        std::array<Rows, kKinds> lit{}, dark{};
    };
    std::array<Asked, PathModel::kMaxShadingPoints> asked_;
    std::size_t count_ = 0;

    // Begins with a shading point; where its rays begin is the caller's. Member by member: what is made first and copied then
    // waits for its own stores.
    Asked& next(const ShadingPoint& at, const Spectrum& light) {
        Asked& a = asked_[count_++];
        a.at = &at, a.light = light, a.like = layer_below(a);
        a.lit = 0, a.of = 1, a.moments = {}, a.kind = 0;
        return a;
    }
    const Asked* layer_below(const Asked& a) const;
    void ask_once(Tile& tile, Vec3f sun_dir);
    void ask_again(Tile& tile, const SunSampler& sun);
    // Is told of a ray that gets through.
    struct Use {
        Asked* asked;
        SubpixelMoments moments;  // where in the pixel it begins
    };
    template <class Rays>
    static void ask(float count, const Tile& tile, const SunSampler& sun, Asked& a, Rays& rays);
    static std::uint8_t kind_of(const ShadingPoint& at);
    Answers within_reach(std::uint32_t width);
    static Rows widened(const Rows& rows);
};

}  // namespace hilcam
