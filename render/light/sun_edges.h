#pragma once
// Shadows' edges on what the camera sees by the visibility buffer, as wide as the Sun's disk makes them.
//
// One ray to the middle of the Sun tells which vertices are lit, and one for all layers of a mosaic in a pixel. Where
// vertices of one kind that differ lie in pixels within kReach_px of each other, an edge passes: each of them asks again, from other places of what its samples see, for
// other places of the disk. A kind is a surface of an object, or more than one, where it faces the same way by and large:
// what lies in shadow behind an edge of the body is no edge of a shadow on what stands before it. The
// approximation: a vertex further off has its one ray, so penumbras wider than twice the reach keep a hard edge
// inside; four rays tell five levels of light, other ones in each of four pixels.

#include <array>
#include <cstdint>

#include "render/light/facet_list.h"
#include "render/light/path_model.h"

namespace hilcam {

class SunSampler;

// Memory for the vertices of a tile. One thread at a time.
class SunEdges {
  public:
    // light: what the vertex sends to the viewer, to its pixel, if all of it is in the Sun. At most
    // PathModel::kMostVertices. Loop, any thread.
    void add(const Vertex& at, const Spectrum& light) {
        Starts& starts = next(at, light);
        starts.at_m[0] = at.start(), starts.share = {1};
    }
    // The same of a vertex with facets: its rays begin at these.
    void add(const Vertex& at, const Spectrum& light, const FacetLight& facets) {
        Starts& starts = next(at, light);
        starts.at_m = facets.start_m, starts.share = facets.lit;
    }
    // Adds the light of all of them to their pixels, as far as the Sun reaches them, and forgets them. Loop, any
    // thread.
    void add_light(Tile& tile, const SunSampler& sun);

  private:
    // Where a vertex' rays begin, and how much of its light each stands for; 0: does not count.
    struct Starts {
        std::array<Vec3f, FacetLight::kStarts> at_m;
        std::array<float, FacetLight::kStarts> share;
    };
    static constexpr int kReach_px = 1, kMaxRows = 32;
    static constexpr std::size_t kKinds = 16;
    static constexpr std::uint32_t kAgain = 4;  // rays
    struct Asked {
        const Vertex* at;
        const Asked* like;  // the one whose first ray tells for it, too; null: it has its own
        Spectrum light;
        Starts starts;
        float lit, of;      // shares that have got through, and that were asked for
        HalfShares halves;  // sums of those that have got through, one by one
        bool by_sample;     // they asked from samples of the pixel
        std::uint8_t kind;  // below kKinds
    };
    using Rows = std::array<std::uint32_t, kMaxRows>;  // a bit for each pixel
    // Pixels with a vertex of a kind that is lit, or dark.
    struct Answers {
        std::array<Rows, kKinds> lit{}, dark{};
    };
    std::array<Asked, PathModel::kMostVertices> asked_;
    std::size_t count_ = 0;

    // Begins with a vertex; where its rays begin is the caller's. Member by member: what is made first and copied then
    // waits for its own stores.
    Starts& next(const Vertex& at, const Spectrum& light) {
        Asked& a = asked_[count_++];
        a.at = &at, a.light = light, a.like = layer_below(a);
        a.lit = 0, a.of = 1, a.halves = {}, a.by_sample = false, a.kind = 0;
        return a.starts;
    }
    const Asked* layer_below(const Asked& a) const;
    void ask_once(Tile& tile, Vec3f sun_dir);
    void ask_again(Tile& tile, const SunSampler& sun);
    static std::uint8_t kind_of(const Vertex& at);
    Answers within_reach(std::uint32_t width);
    static Rows widened(const Rows& rows);
};

}  // namespace hilcam
