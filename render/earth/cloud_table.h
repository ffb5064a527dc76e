#pragma once
// The light that a plane layer of cloud reflects and lets through, from tables made at start-up.
//
// Particles are water droplets of 10 um effective radius and variance 0.15 (phase_function.h). Light scattered more than once is
// the same in all bins, by doubling (adding_doubling.h); once scattered light has each bin's own phase function, exactly
// (Nakajima & Tanaka, J. Quant. Spectrosc. Radiat. Transfer 40, 51, 1988), so that the bow, the glory and the bright edges towards the
// Sun are there. Thickness is told by c = b tau / (1 + b tau) with b = (1 - 0.85) / 2, which is about a thick
// cloud's albedo (Bohren, Am. J. Phys. 55, 524, 1987) and so may be averaged.
//
// What it does not model: absorption (none below 1 um), ice crystals, sides of clouds, light that leaves at another
// place than where it came in.

#include <vector>

#include "render/earth/earth_aspect.h"

namespace hilcam {

class CloudTable {
  public:
    explicit CloudTable(const SpectralGrid& grid);

    static constexpr float kB = 0.075f;
    // Optical thickness of what is not scattered straight on.
    float scaled_thickness(float c) const { return left_ * c / (kB * std::max(1e-3f, 1 - c)); }

    // Sets the tables of an aspect: mu0, mu: cosines of the zenith angles of Sun and viewer; cos_phase: of the angle
    // between the directions to both. Loop, any thread.
    void place(float mu0, float mu, float cos_phase, EarthAspect& aspect) const;
    // Radiance times pi over the beam's irradiance on the layer, per bin, in that aspect.
    static Spectrum reflected(const EarthAspect& aspect, float c);
    // The share of light from one direction that comes through, the beam itself included; what does not is reflected.
    float transmitted(float c, float mu) const;
    // The share of an even sky's light that is reflected.
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
    std::vector<Spectrum> phase_;     // by PhaseFunction::place

    static float cosine_at(int i);
    static float thickness_of(float c) { return c * (kThick - 1); }
};

}  // namespace hilcam
