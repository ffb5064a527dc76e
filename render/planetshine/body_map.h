#pragma once
// The radiance of a body's disk as objects see it: a picture with mip levels, for narrow facet lobes that
// each see many of its places. Made once per frame.
//
// The picture is Lambert's azimuthal projection of the cone around the disk (Snyder, Map Projections, USGS
// Professional Paper 1395, 1987, ch. 24), so all texels have the same solid angle.

#include <array>
#include <vector>

#include "render/background/background.h"

namespace hilcam {

class BodyMap {
  public:
    // A texel is half as wide as the alpha of the narrowest lobe, but at least this wide [rad]: about the
    // part of a solar cell's lobe that one of sixteen facets sees.
    static constexpr float kNarrowest_rad = 0.02f;
    static constexpr int kMinSide = 8, kMaxSide = 64;

    BodyMap();

    // Renders the disk inside a cone about `axis` (world, unit). narrowest_alpha: GGX alpha of the narrowest
    // lobe that will be looked up. Loop; no allocation of its own.
    void place(const Background& background, Vec3f axis, float one_minus_cosine, float narrowest_alpha);

    float texel_sr() const { return texel_sr_; }
    // Returns the mean radiance about a direction (unit, world) over `spread_sr` or a texel; zero outside the
    // cone. Loop, any thread.
    Spectrum about(Vec3f dir, float spread_sr) const;

  private:
    static constexpr int kLevels = 4;  // sides of 64, 32, 16, 8
    struct Place {
        Vec3f dir;
        bool inside;
    };
    Frame frame_{{0, 0, 1}};
    int side_ = kMinSide, levels_ = 1;
    float radius_ = 1;  // radius of the cone in the projection: 2 sin(half angle / 2)
    float texel_sr_ = 1;
    // By level, each with a border of zeros.
    std::array<std::vector<Spectrum>, kLevels> texels_;

    Place place_of(int x, int y) const;
    const Spectrum* texel(int level, int x, int y) const {
        return &texels_[static_cast<std::size_t>(level)][index(level, x, y)];
    }
    std::size_t index(int level, int x, int y) const {
        return static_cast<std::size_t>((y + 1) * ((side_ >> level) + 2) + x + 1);
    }
    void halve(int level);
};

}  // namespace hilcam
