#include "render/background/scene_bodies.h"

#include "render/earth/earth_model.h"
#include "render/sky/air_refraction.h"

namespace hilcam {

double SceneBodies::max_turn_rad() const {
    const AirRefraction* bends = air ? air->refraction() : nullptr;
    return bends ? bends->max_turn_rad() : 0;
}

double SceneBodies::top_m(BodyId id) const {
    return has_air(id) ? air->top_m() : (is_modelled(id) ? EarthModel::kHighest_m : 0);
}

std::string SceneBodies::name_of(BodyId id) const {
    const std::string& own = (*this)[id].name;
    if (!own.empty()) return own;
    return index_of(id) < kBodyCount ? std::string(kBodyNames[index_of(id)]) : "body";
}

}  // namespace hilcam
