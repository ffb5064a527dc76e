#pragma once
// The light of the bodies (Earth, Moon, planets) on a surface without anything between: what a place with a free sky
// has of it. Made once a frame from a quadrature over each body's disk, so nothing of it is left to chance.

#include <array>
#include <vector>

#include "render/scene/background.h"
#include "render/scene/brdf_microfacet.h"

namespace hilcam {

class SkyLight {
  public:
    static constexpr std::size_t kMostBodies = 3;
    // Bodies that cannot give this share of what white paint sends in the Sun are left out.
    static constexpr float kLeastOverSun = 1e-5f;

    SkyLight();

    // For a frame: the background is placed. On oneTBB. Loop.
    void place(const Background& background);

    struct Body {
        Vec3f world_dir;
        float cone_cosine = 1;
        Spectrum irradiance_w_m2_um;  // on a surface that faces it
    };
    std::span<const Body> bodies() const { return {bodies_.data(), count_}; }

    // Irradiance [W m^-2 um^-1] on a surface with this normal. Loop, any thread.
    Spectrum irradiance(std::size_t body, Vec3f world_normal) const { return irradiance_[body].at(world_normal); }
    // Mean radiance that a facet lobe (GGX alpha, kLeastAlpha at least) finds about the mirror's direction; the lobe is
    // as one sees it along the normal (Karis, SIGGRAPH 2013 course: the first part of the split sum).
    Spectrum glossy(std::size_t body, Vec3f world_dir, float alpha) const;
    static constexpr float kLeastAlpha = 0.03f;

  private:
    // A function of the direction, on an octahedron's faces (Cigolle et al., JCGT 3(2), 2014); bilinear.
    struct DirectionMap {
        static constexpr int kSteps = 16;
        std::vector<Spectrum> value = std::vector<Spectrum>((kSteps + 1) * (kSteps + 1));
        static Vec3f direction(int index);
        Spectrum at(Vec3f dir) const;
    };
    // About a body's middle, by the angle from it in any direction (azimuthal equidistant); zero further off.
    struct ConeMap {
        static constexpr int kSteps = 32;
        float reach_rad = 0;
        std::vector<Spectrum> value = std::vector<Spectrum>((kSteps + 1) * (kSteps + 1));
        Vec3f direction(const Frame& axis, int index) const;
        Spectrum at(const Frame& axis, Vec3f dir) const;
    };
    static constexpr std::array<float, 5> kAlphas = {kLeastAlpha, 0.06f, 0.12f, 0.25f, 0.5f};

    std::size_t count_ = 0;
    std::array<Body, kMostBodies> bodies_;
    std::array<DirectionMap, kMostBodies> irradiance_;
    std::array<std::array<ConeMap, kAlphas.size()>, kMostBodies> glossy_;
};

}  // namespace hilcam
