#pragma once
// The BRDF tells how a point of a surface scatters light. This header has values, densities and samples of
// every reflection model of material.h.
//
// All models are isotropic, so a BRDF is a function of three cosines: those of viewer and light to the
// shading normal, and the one between viewer and light. Values are f [sr^-1], without the cosine; densities
// are per solid angle of the light's direction. Exact reflection and transmission have no value: only
// sample() gives them, as `exact`. Loop, any thread.

#include <array>

#include "render/scene/material.h"
#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// The BSDF at one point: a material with its spectra and lobe at that point. Textures scale the spectra, and
// the facet lobe is at least as wide as the material's own (shading_point.h).
struct Bsdf : BsdfInputs {
    const Material* material = nullptr;

    Bsdf() = default;
    Bsdf(const Material* of, float lobe_alpha, const Spectrum& own_base, const Spectrum& own_highlight)
        : BsdfInputs{lobe_alpha, own_base, own_highlight}, material(of) {}

    bool is_glass() const { return material->transmits(); }
    // True when some light goes in exactly one direction, which random sampling of lamps cannot find.
    bool has_exact() const { return is_glass() || (alpha == 0 && material->has_facets()); }
    // True when some light is scattered in all directions.
    bool has_lobes() const {
        return is_glass() ? material->traits().has_body : !(alpha == 0 && material->is_bare());
    }
};

struct BrdfSample {
    Vec3f dir;               // towards the light, unit, world
    Spectrum weight;         // f cos / density, or the whole reflectance if exact
    float density = 0;       // 0 if exact
    bool exact = false;      // the one direction of a mirror or a sheet
    bool transmits = false;  // continues on the other side of the surface
    bool diffuse = false;    // true for the diffuse part, false for the highlight
    bool valid = false;
};

// Returns f for light from above the surface (no, ni > 0); zero otherwise.
Spectrum brdf_value(const Bsdf& at, Cosines c);
// Returns the part of it that facets do not mirror at once; all of it without facets.
Spectrum brdf_diffuse_value(const Bsdf& at, Cosines c);
// Returns the albedo of a material's facets; null if it has none.
const LobeAlbedo* facets_of(const Material& material);

// Returns the density of sample() for a direction, without the exact parts. It is 0 for the body of a veil:
// samples go straight on, so that what is behind a veil is seen without noise.
float brdf_density(const Bsdf& at, Cosines c);
// Draws a direction roughly in proportion to f cos. u: three uniform numbers.
BrdfSample brdf_sample(const Bsdf& at, Vec3f normal, Vec3f view_dir, std::array<float, 3> u);
// Returns one of the exact parts: 0 reflection, 1 transmission. The weight is the whole reflectance or
// transmittance in that direction.
BrdfSample brdf_exact(const Bsdf& at, Vec3f normal, Vec3f view_dir, int part);
// Returns the transmittance of a sheet at this cosine; zero for everything that is not glass.
Spectrum sheet_transmittance(const Bsdf& at, float cosine);
// Returns roughly the share of light that is reflected in all directions, for light from the viewer's side.
// It is used to choose between parts of a sample and to end paths.
float brdf_albedo(const Bsdf& at, float no, int bins);
// Returns the share of light from 45 degrees that a material reflects in all directions, at most 1: a mean
// over the bins, without the colours of textures. Not for the loop.
double reflectance_of(const Material& material, const SpectralGrid& grid);
// Returns the reflectance of a facet at this cosine; zero for models without facets.
Spectrum brdf_mirrored(const Bsdf& at, float cosine);
// Returns the share of light that facets leave for multiple reflections or the body below them, 1 - E(no); 1
// without facets.
float brdf_below_facets(const Material& material, float no);

}  // namespace hilcam
