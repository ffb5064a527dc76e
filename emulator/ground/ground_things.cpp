#include "emulator/ground/ground_things.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "emulator/ground/globe_loader.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

template <class Thing>
std::vector<GroundThing> found_in(const auto& field, const MappedBody& body, Vec3d middle, double within_m,
                                  double smallest_m, double smallest_seeded_m, const char* what,
                                  const char* keys, double Thing::*figure) {
    require_few(field.per_m2_at(middle, std::max(smallest_m, smallest_seeded_m)) * kPi * within_m * within_m,
                what, keys);
    std::vector<Thing> found;
    field.find(middle, within_m / body.figure.equatorial_radius_m, smallest_m, found);
    std::vector<GroundThing> out;
    out.reserve(found.size());
    for (const Thing& thing : found) out.push_back({thing.place, thing.diameter_m, thing.*figure});
    return out;
}

}  // namespace

void require_few(double count, const char* what, const char* keys) {
    if (count > kMaxListed)
        throw InputError(fmt::format("{}: there are about {:.2g} {} there; accepted: {:.0g}", keys, count,
                                     what, kMaxListed));
}

std::vector<GroundThing> find_things(GroundThings kind, const GlobeConfig& globe, const MappedBody& body,
                                     Vec3d middle, double within_m, double smallest_m, const char* keys) {
    if (kind == GroundThings::kCraters) {
        if (!globe.craters) throw InputError("terrain.globe.craters: there are none in this scenario");
        const CraterField field(body.figure.equatorial_radius_m, *globe.craters);
        return found_in(field, body, middle, within_m, smallest_m, globe.craters->smallest_m, "craters", keys,
                        &Crater::worn);
    }
    if (!globe.boulders) throw InputError("terrain.globe.boulders: there are none in this scenario");
    const auto field = boulders_of(globe, body);
    if (!field) return {};  // an abundance of 0
    return found_in(*field, body, middle, within_m, smallest_m, globe.boulders->smallest_m, "boulders", keys,
                    &Boulder::height_m);
}

}  // namespace hilcam
