#pragma once
// The bodies of a scene, and which of them has what.

#include <array>
#include <string>

#include "render/scene/scene.h"

namespace hilcam {

// All that it points to outlives it.
struct SceneBodies {
    const std::array<SceneBody, kMaxBodies>* all;
    const Atmosphere* air;    // the Earth's; null: none
    const EarthModel* earth;  // the Earth's look by its model (render/earth); null: by its law as a body

    const SceneBody& operator[](BodyId id) const { return (*all)[index_of(id)]; }
    bool has_rings(BodyId id) const { return id == BodyId::kSaturn && (*this)[id].rings; }
    bool has_air(BodyId id) const { return air && id == BodyId::kEarth; }
    bool is_modelled(BodyId id) const { return earth && id == BodyId::kEarth; }
    // Returns how its air bends rays; null: not at all.
    const AirRefraction* refraction(BodyId id) const { return has_air(id) ? air->refraction() : nullptr; }
    // Returns how far above its ground a body is to be seen [m].
    double top_m(BodyId id) const;
    std::string name_of(BodyId id) const;
};

}  // namespace hilcam
