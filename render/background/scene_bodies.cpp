#include "render/background/scene_bodies.h"

#include "render/earth/earth_model.h"

namespace hilcam {

double SceneBodies::top_m(BodyId id) const {
    return has_air(id) ? air->top_m() : (is_modelled(id) ? EarthModel::kHighest_m : 0);
}

std::string SceneBodies::name_of(BodyId id) const {
    const std::string& own = (*this)[id].name;
    if (!own.empty()) return own;
    return index_of(id) < kBodyCount ? std::string(kBodyNames[index_of(id)]) : "body";
}

}  // namespace hilcam
