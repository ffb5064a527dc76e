#pragma once
// The form of a reflection model: a small struct in a file of its own, named as scenarios name it.
//
// Directions are given by three cosines: of the viewer and the light to the shading normal, and of the two to
// each other. Values are f [sr^-1], without the cosine; densities are per solid angle of the light's
// direction. All functions of a model but its constructor: loop, any thread.
//
// A model has a name (kName), value(), and what of the following it does not leave as it is in BrdfModel. It
// is made by Model(const Keys&, BrdfMaking&); brdf_models.h lists it. docs/extending.md adds one.

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

// The mean over the bins of the grid.
inline float mean(const Spectrum& s, int bins) {
    float sum = 0;
    for (int b = 0; b < kMaxBins; ++b) sum += s[b];
    return sum / static_cast<float>(bins);
}

// The look of a surface: all that its textures and its level of detail change of a model at a point.
struct BsdfInputs {
    float alpha = 0;     // alpha of the facet lobe; 0: an exact mirror on top
    Spectrum base;       // the model's `reflectance`, unless it says otherwise
    Spectrum highlight;  // zero, unless the model says otherwise; what facets reflect at normal incidence
    std::optional<HapkeParameters> hapke{};  // the place's own, where maps of the ground have them
};

// Keys of a material that several models share, or that are no model's.
struct MaterialKeys {
    std::string source;                        // where the figures come from
    std::size_t model = 0;                     // place in Brdf (brdf_models.h)
    Curve reflectance = Curve::constant(0.5);  // each model says of what
    double roughness = 0.3;                    // metal, dielectric: GGX alpha is its square; oren_nayar: r
    double refractive_index = 1.5;             // dielectric, glass
    double temperature_k = 0;                  // 0: no emission
    std::filesystem::path table;               // a measured BRDF: MERL's .binary or our CSV
};

inline double largest_value(const Curve& curve) {
    return *std::max_element(curve.value.begin(), curve.value.end());
}

// The parts that a model is made from; it may change the look.
struct BrdfMaking {
    const MaterialKeys& keys;
    const SpectralGrid& grid;
    std::shared_ptr<const BrdfTable> table;  // the table of keys.table; null where that is empty
    BsdfInputs look;                         // base: the averages of keys.reflectance

    // Throws InputError where the curve does not cover the grid.
    Spectrum average(const Curve& curve, const std::string& key) const {
        require_cover(curve, grid, key);
        return grid.average(curve);
    }
};

// The traits of a model that says nothing else: it is diffuse, without keys of its own.
template <class Model>
struct BrdfModel {
    static constexpr bool kHasFacets = false;      // FacetModel has them
    static constexpr bool kHasBody = true;         // light goes in all directions even where alpha is 0
    static constexpr bool kTransmits = false;      // a sheet: mirrored() and passed(), and of a body value()
    static constexpr bool kTakesTable = false;     // key `table` goes with it
    static constexpr bool kAlbedoIsBound = false;  // albedo() is far above what it reflects

    // The keys that it takes of those that models share.
    static constexpr std::array<std::string_view, 1> kSharedKeys{"reflectance"};
    // Keys of its own; check() throws InputError for what would create light.
    struct Keys {};
    static Fields fields(Keys&) { return {}; }
    static void check(const MaterialKeys&, const auto&) {}

    // The chance that a sample is of the highlight; the others go by the cosine.
    float highlight_chance(const BsdfInputs&, float) const { return 0; }
    // The highlight's own density, and a direction towards the light by it, world. local: about the normal.
    float highlight_density(const BsdfInputs&, Cosines) const { return 0; }
    Vec3f sample_highlight(const BsdfInputs&, const Frame& local, Vec3f, float, float) const {
        return local.n;
    }
    // Returns what is reflected in the mirror's direction, by a facet or a sheet that is met at this cosine.
    Spectrum mirrored(const BsdfInputs&, float) const { return {}; }
    // Returns what goes through a sheet.
    Spectrum passed(const BsdfInputs&, float) const { return {}; }
    // The share of light that comes back in all directions, about: chooses a sample's part, ends paths.
    float albedo(const BsdfInputs& at, float, int bins) const { return mean(at.base, bins); }
};

}  // namespace hilcam
