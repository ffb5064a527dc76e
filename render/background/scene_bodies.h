#pragma once
// The bodies of a scene, and the features of each.

#include <array>
#include <string>

#include "render/scene/scene.h"

namespace hilcam {

// Everything that it points to must outlive it.
struct SceneBodies {
    const std::array<SceneBody, kMaxBodies>* all;
    const Atmosphere* air;    // the Earth's; null: none
    const EarthModel* earth;  // the Earth's model (render/earth); null: drawn like other bodies

    const SceneBody& operator[](BodyId id) const { return (*all)[index_of(id)]; }
    bool has_rings(BodyId id) const { return id == BodyId::kSaturn && (*this)[id].rings; }
    bool has_air(BodyId id) const { return air && id == BodyId::kEarth; }
    bool is_modelled(BodyId id) const { return earth && id == BodyId::kEarth; }
    // Returns how a body's air bends rays; null if it does not.
    const AirRefraction* refraction(BodyId id) const { return has_air(id) ? air->refraction() : nullptr; }
    // Returns the largest angle by which air bends a ray.
    double max_turn_rad() const;
    // Returns how high above its ground a body is visible [m].
    double top_m(BodyId id) const;
    std::string name_of(BodyId id) const;
};

}  // namespace hilcam
