#pragma once
// Finds the edges of shadows and renders them as wide as the Sun's disk makes them. It serves what the
// camera sees through the visibility buffer. See docs/rendering.md, "The Sun and its penumbrae".
//
// One ray to the middle of the Sun tests each shading point; all layers of a coverage map in a pixel share
// one. Where rays of one kind of points within kReach_px disagree, an edge is near: points there send more
// rays, from their own samples to places on the disk, as many as their light asks for (kRounds). So does
// each highlight that is brighter than white paint, because a strip of sunlight thinner than a pixel may
// pass beside its middle. For a point with clusters, each ray represents an equal share of its light and
// starts at the samples of a cluster. A kind is one or several surfaces of an object that face roughly the
// same way, so that a shadow on something behind the edge of a body is not taken for an edge on that body.
//
// Approximation: points farther from an edge have one ray, so penumbrae much wider than the reach keep a
// hard step inside, and strips of sunlight on paint that are thinner than a pixel may be dashed.

#include <array>
#include <cstdint>

#include "render/shading/normal_clusters.h"
#include "render/shading/path_model.h"

namespace hilcam {

class SunSampler;

// Memory for the shading points of a tile. One thread at a time.
class PenumbraSampler {
  public:
    // Adds a shading point. light: what it sends to its pixel if all of it is in the Sun. At most
    // PathModel::kMaxShadingPoints. Loop, any thread.
    void add(const ShadingPoint& at, const Spectrum& light) {
        Asked& asked = next(at, light);
        asked.clusters[0] = nullptr, asked.shares = {1};
        asked.moments_of_all = at.moments;
        asked.first_m = at.start();
    }
    // Adds a shading point with clusters, at which its rays start.
    void add(const ShadingPoint& at, const Spectrum& light, const ClusterLight& clusters) {
        Asked& asked = next(at, light);
        asked.clusters = clusters.brightest, asked.shares = clusters.share;
        asked.moments_of_all = clusters.moments;
        asked.first_m = clusters.brightest[0]->start_m;
    }
    // Adds the sunlit share of their light to their pixels, and forgets the points. Loop, any thread.
    void add_light(Tile& tile, const SunSampler& sun);

  private:
    static constexpr int kReach_px = 1, kMaxRows = 32;
    static constexpr std::size_t kKinds = 16;
    // The rounds of rays near an edge, and the light above which a point takes part if all of it is in the
    // Sun [pixels of white paint in the Sun]. A point that sends a 64th has one ray: at most half of that is
    // wrong, the noise of a full well of 15,000 electrons. In small objects with many parts most points are
    // such. All rays of a round count as answers for the next, so rounds follow an edge along the picture.
    // Direct light of a lit Hubble is off by 2.7 sensor noises (rms) without the third round, 2.6 with it.
    struct Round {
        float rays, light;
    };
    static constexpr std::array<Round, 3> kRounds{{{4, 1.0f / 64}, {16, 1.0f / 16}, {64, 1}}};
    struct Asked {
        const ShadingPoint* at;
        const Asked* like;  // the point whose first ray decides for this one, too; null: it has its own
        Spectrum light;
        float whites;   // the same in pixels of white paint in the Sun
        Vec3f first_m;  // start of the first ray
        // The clusters that have most of the light, and how much; null: it has none.
        std::array<const NormalCluster*, ClusterLight::kStarts> clusters;
        std::array<float, ClusterLight::kStarts> shares;
        float lit, of;                   // rays that got through, and rays that were sent
        SubpixelMoments moments_of_all;  // where the light is if no ray is blocked
        SubpixelMoments moments;         // summed over the rays that got through
        std::uint8_t kind;               // below kKinds
    };
    // Highlights have at least this many rays for the light of a pixel of white paint, edge or not. Without
    // them a single strip of sunlight is dashed where no first ray meets it (ShadowsEdge's test).
    static constexpr float kPerWhite = 4;
    static bool always_has(std::size_t round, const Asked& a) {
        return round < kRounds.size() && kRounds[round].rays <= kPerWhite * a.whites;
    }
    using Rows = std::array<std::uint32_t, kMaxRows>;  // a bit for each pixel
    // Pixels with a lit, or dark, shading point of a kind.
    struct Answers {
        std::array<Rows, kKinds> lit{}, dark{};
        std::uint32_t lit_kinds = 0, dark_kinds = 0;  // those with any; a bit each
    };
    std::array<Asked, PathModel::kMaxShadingPoints> asked_;
    std::size_t count_ = 0;

    // Starts a new entry; the caller sets where its rays start. Set member by member: a temporary that is
    // copied would have to wait for its own stores.
    Asked& next(const ShadingPoint& at, const Spectrum& light) {
        Asked& a = asked_[count_++];
        a.at = &at, a.light = light, a.like = layer_below(a);
        a.lit = 0, a.of = 1, a.moments = {}, a.kind = 0;
        return a;
    }
    const Asked* layer_below(const Asked& a) const;
    void ask_once(Tile& tile, Vec3f sun_dir);
    void ask_again(Tile& tile, const SunSampler& sun);
    // Receives a ray that got through.
    struct Use {
        Asked* asked;
        SubpixelMoments moments;  // where in the pixel it started
    };
    template <class Rays>
    static void ask(float count, const Tile& tile, const SunSampler& sun, Asked& a, Rays& rays);
    static std::uint8_t kind_of(const ShadingPoint& at);
    void add_answers(std::uint32_t width, Answers& to) const;
    static Answers widened(const Answers& of);
    static Rows widened(const Rows& rows);
};

}  // namespace hilcam
