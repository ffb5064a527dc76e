#pragma once
// The BRDF says how a point of a surface scatters light: values, densities and samples of every reflection
// model of material.h.
//
// All models are isotropic, so a BRDF is a function of three cosines: of the viewer and the light to the
// shading normal, and of the two to each other. Values are f [sr^-1], without the cosine; densities are per
// solid angle of the light's direction. Exact reflection and transmission have no value: only sample() gives
// them, as `exact`. Loop, any thread.

#include <array>

#include "render/scene/material.h"
#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// The BSDF at one point: a material, and what it takes there (textures scale the spectra; the facet lobe is
// at least as wide as the material's own, see shading_point.h).
struct Bsdf : BsdfInputs {
    const Material* material = nullptr;

    Bsdf() = default;
    Bsdf(const Material* of, float lobe_alpha, const Spectrum& own_base, const Spectrum& own_highlight)
        : BsdfInputs{lobe_alpha, own_base, own_highlight}, material(of) {}

    bool is_glass() const { return material->transmits(); }
    // Some light goes in exactly one direction, which no lamp is met in by chance.
    bool has_exact() const { return is_glass() || (alpha == 0 && material->has_facets()); }
    // Some light goes in all directions.
    bool has_lobes() const {
        return is_glass() ? material->traits().has_body : !(alpha == 0 && material->is_bare());
    }
};

struct BrdfSample {
    Vec3f dir;               // towards the light, unit, world
    Spectrum weight;         // f cos / density, or the whole reflectance where exact
    float density = 0;       // 0 where exact
    bool exact = false;      // a mirror's or a sheet's one direction
    bool transmits = false;  // goes on to the other side
    bool diffuse = false;    // true for the diffuse part, false for the highlight
    bool valid = false;
};

// f for light from above the surface (no, ni > 0); zero otherwise.
Spectrum brdf_value(const Bsdf& at, Cosines c);
// Returns how much a material's facets reflect; null: it has none.
const LobeAlbedo* facets_of(const Material& material);

// Density of sample() for a direction, exact parts left out. None is drawn in a veil's body, so that what lies behind is seen without noise.
float brdf_density(const Bsdf& at, Cosines c);
// A direction in proportion to f cos, about. u: three uniform numbers.
BrdfSample brdf_sample(const Bsdf& at, Vec3f normal, Vec3f view_dir, std::array<float, 3> u);
// The exact parts alone, one after the other: 0 reflection, 1 transmission; the weight is the whole
// reflectance or transmittance in that direction.
BrdfSample brdf_exact(const Bsdf& at, Vec3f normal, Vec3f view_dir, int part);
// Transmittance of a sheet for a ray at this cosine; zero for all that is not glass.
Spectrum sheet_transmittance(const Bsdf& at, float cosine);
// The share of light that comes back in all directions for light from the viewer's side, about: what chooses
// a sample's part and ends a path.
float brdf_albedo(const Bsdf& at, float no, int bins);
// Returns the share of light from 45 degrees that a material sends back in all directions, 1 at most, as a mean over
// the bins and without textures' colours. Not for the loop.
double reflectance_of(const Material& material, const SpectralGrid& grid);
// Returns what a facet reflects that is met at this cosine; zero of models without facets.
Spectrum brdf_mirrored(const Bsdf& at, float cosine);
// Returns what facets leave to several reflections or the body below them, 1 - E(no); 1 without facets.
float brdf_below_facets(const Material& material, float no);

}  // namespace hilcam
