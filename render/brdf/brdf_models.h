#pragma once
// The list of reflection models. A new model is a header in this folder and its name at the end of the list.

#include <array>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "render/brdf/dielectric.h"
#include "render/brdf/glass.h"
#include "render/brdf/hapke.h"
#include "render/brdf/lambert.h"
#include "render/brdf/lommel_seeliger.h"
#include "render/brdf/measured.h"
#include "render/brdf/metal.h"
#include "render/brdf/mirror.h"
#include "render/brdf/oren_nayar.h"
#include "render/brdf/phong.h"
#include "render/brdf/veil.h"

namespace hilcam {

using Brdf =
    std::variant<brdf::Lambert, brdf::Metal, brdf::Dielectric, brdf::Mirror, brdf::Glass, brdf::OrenNayar,
                 brdf::Phong, brdf::LommelSeeliger, brdf::Hapke, brdf::Measured, brdf::Veil>;

// --- derived from the list

template <class List>
struct ModelList;
template <class... Models>
struct ModelList<std::variant<Models...>> {
    // The keys of a material: those that models share, and each model's own.
    struct Keys : MaterialKeys, Models::Keys... {};

    static constexpr std::size_t kCount = sizeof...(Models);
    static constexpr std::array<std::string_view, kCount> kNames = {Models::kName...};

    // Calls visit.operator()<Model>() for every model.
    template <class Visit>
    static constexpr void for_each(const Visit& visit) {
        (visit.template operator()<Models>(), ...);
    }
};
using BrdfModels = ModelList<Brdf>;

// The index of a model in the list: MaterialKeys::model, Brdf::index().
template <class Model>
inline constexpr std::size_t kModel = [] {
    std::size_t place = 0;
    bool found = false;
    BrdfModels::for_each([&]<class M>() {
        if constexpr (std::is_same_v<M, Model>) found = true;
        if (!found) ++place;
    });
    return place;
}();

// The properties of a model that other code asks for, by its index.
struct BrdfTraits {
    bool has_facets, has_body, transmits, takes_table, albedo_is_bound;
};
inline constexpr auto kBrdfTraits = [] {
    std::array<BrdfTraits, BrdfModels::kCount> traits{};
    BrdfModels::for_each([&]<class M>() {
        traits[kModel<M>] = {M::kHasFacets, M::kHasBody, M::kTransmits, M::kTakesTable, M::kAlbedoIsBound};
    });
    return traits;
}();

}  // namespace hilcam
