#pragma once
// The light that a plane layer of cloud reflects and transmits, from tables made at start-up.
//
// Particles are water droplets with an effective radius of 10 um and a variance of 0.15 (phase_function.h).
// Multiply scattered light is the same in all bins, by doubling (adding_doubling.h). Singly scattered light
// uses each bin's exact phase function (Nakajima & Tanaka, J. Quant. Spectrosc. Radiat. Transfer 40, 51,
// 1988), so there are the bow, the glory and bright edges towards the Sun. Thickness is given by c = b tau /
// (1 + b tau) with b = (1 - 0.85) / 2, which is roughly the albedo of a thick cloud (Bohren, Am. J. Phys. 55,
// 524, 1987) and can therefore be averaged.
//
// Not modelled: absorption (none below 1 um), ice crystals, sides of clouds, light that leaves at another
// place than where it entered.

#include <vector>

#include "render/earth/earth_aspect.h"

namespace hilcam {

class CloudTable {
  public:
    explicit CloudTable(const SpectralGrid& grid);

    static constexpr float kB = 0.075f;
    // Returns the optical thickness of everything but forward scattering.
    float scaled_thickness(float c) const { return left_ * c / (kB * std::max(1e-3f, 1 - c)); }

    // Fills an aspect's tables. mu0, mu: cosines of the zenith angles of Sun and viewer; cos_phase: of the
    // angle between the directions to both. Loop, any thread.
    void place(float mu0, float mu, float cos_phase, EarthAspect& aspect) const;
    // Returns the radiance times pi over the beam's irradiance on the layer, per bin, for that aspect.
    static Spectrum reflected(const EarthAspect& aspect, float c);
    // Returns the share of light from one direction that comes through, including the beam; the rest is
    // reflected.
    float transmitted(float c, float mu) const;
    // Returns the share of a uniform sky's light that is reflected.
    float spherical_albedo(float c) const;
    std::size_t bytes() const {
        return sizeof(float) * (multiple_.size() + transmitted_.size() + spherical_.size()) +
               sizeof(Spectrum) * phase_.size();
    }

  private:
    static constexpr int kThick = 24, kCosines = 16, kAzimuths = 19;
    float left_ = 1;                  // 1 - f
    std::vector<float> multiple_;     // [azimuth][sun][view][thickness]
    std::vector<float> transmitted_;  // [cosine][thickness]
    std::vector<float> spherical_;    // [thickness]
    std::vector<Spectrum> phase_;     // indexed by PhaseFunction::place

    static float cosine_at(int i);
    static float thickness_of(float c) { return c * (kThick - 1); }
};

}  // namespace hilcam
