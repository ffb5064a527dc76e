#pragma once
// The form of a reflection model: a small struct in a file of its own, with the name that scenarios use.
//
// Directions are given by three cosines: those of viewer and light to the shading normal, and the one between
// viewer and light. Values are f [sr^-1], without the cosine; densities are per solid angle of the light's
// direction. All functions of a model except its constructor: loop, any thread.
//
// A model has a name (kName), value(), and overrides for whatever differs from BrdfModel. Its constructor is
// Model(const Keys&, BrdfMaking&), and brdf_models.h lists it. docs/extending.md adds one as an example.

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "render/brdf/microfacet.h"
#include "render/vocabulary/config_field.h"
#include "render/vocabulary/hapke_parameters.h"
#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

class BrdfTable;

struct Cosines {
    float no, ni, io;
};

struct HalfVector {
    float nh, ih;
};
inline HalfVector half_vector(Cosines c) {
    const float length_squared = std::max(2 + 2 * c.io, 1e-8f);
    return {std::clamp((c.no + c.ni) / std::sqrt(length_squared), 0.0f, 1.0f),
            0.5f * std::sqrt(length_squared)};
}

// Returns the mean over the bins of the grid.
inline float mean(const Spectrum& s, int bins) {
    float sum = 0;
    for (int b = 0; b < kMaxBins; ++b) sum += s[b];
    return sum / static_cast<float>(bins);
}

// The inputs of a model at one point: everything that textures and levels of detail change.
struct BsdfInputs {
    float alpha = 0;     // GGX alpha of the facet lobe; 0: an exact mirror
    Spectrum base;       // the model's `reflectance`, unless it says otherwise
    Spectrum highlight;  // reflectance of facets at normal incidence; zero, unless the model sets it
    std::optional<HapkeParameters> hapke{};  // this place's own, if maps of the ground have them
};

// Keys of a material that several models share, or that belong to no model.
struct MaterialKeys {
    std::string source;                        // origin of the figures
    std::size_t model = 0;                     // index in Brdf (brdf_models.h)
    Curve reflectance = Curve::constant(0.5);  // each model says what it means
    double roughness = 0.3;                    // metal, dielectric: GGX alpha is its square; oren_nayar: r
    double refractive_index = 1.5;             // dielectric, glass
    double temperature_k = 0;                  // 0: no emission
    Curve infrared_emissivity;                 // hemispherical, of the thermal bins
    bool has_infrared_emissivity = false;
    std::filesystem::path table;  // a measured BRDF: MERL's .binary or our CSV
};

inline double largest_value(const Curve& curve) {
    return *std::max_element(curve.value.begin(), curve.value.end());
}

// The ingredients of a model; the model may change `look`.
struct BrdfMaking {
    const MaterialKeys& keys;
    const SpectralGrid& grid;
    std::shared_ptr<const BrdfTable> table;  // read from keys.table; null if that is empty
    BsdfInputs look;                         // base: averages of keys.reflectance

    // Throws InputError if the curve does not cover the grid below the thermal bins; in these it keeps its
    // end.
    Spectrum average(const Curve& curve, const std::string& key) const {
        require_solar_cover(curve, grid, key);
        return grid.average(curve);
    }
};

// The defaults of a model: diffuse, without keys of its own.
template <class Model>
struct BrdfModel {
    static constexpr bool kHasFacets = false;  // set by FacetModel
    static constexpr bool kHasBody = true;     // light goes in all directions, even if alpha is 0
    static constexpr bool kTransmits = false;  // a sheet: has mirrored() and passed(), and value() for a body
    static constexpr bool kTakesTable = false;     // uses the key `table`
    static constexpr bool kAlbedoIsBound = false;  // albedo() is far above the real value

    // The shared keys that it uses.
    static constexpr std::array<std::string_view, 1> kSharedKeys{"reflectance"};
    // Keys of its own. check() throws InputError for values that would create light.
    struct Keys {};
    static Fields fields(Keys&) { return {}; }
    static void check(const MaterialKeys&, const auto&) {}

    // Returns the probability that a sample is drawn from the highlight; others follow the cosine.
    float highlight_chance(const BsdfInputs&, float) const { return 0; }
    // The highlight's density, and a direction towards the light drawn from it (world). local: frame about
    // the normal.
    float highlight_density(const BsdfInputs&, Cosines) const { return 0; }
    Vec3f sample_highlight(const BsdfInputs&, const Frame& local, Vec3f, float, float) const {
        return local.n;
    }
    // Returns the reflectance of a facet or sheet at this cosine.
    Spectrum mirrored(const BsdfInputs&, float) const { return {}; }
    // Returns the transmittance of a sheet.
    Spectrum passed(const BsdfInputs&, float) const { return {}; }
    // Returns roughly the share of light that is reflected in all directions. It is used to choose between
    // parts of a sample and to end paths.
    float albedo(const BsdfInputs& at, float, int bins) const { return mean(at.base, bins); }
};

}  // namespace hilcam
