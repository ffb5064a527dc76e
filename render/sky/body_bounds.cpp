#include "render/sky/body_bounds.h"

namespace hilcam {

bool take_possible(const Bodies& found, Bodies& kept) {
    constexpr double kFarthestApart_m = 2 * kFarthestPlace_m;
    bool all = true;
    const auto take = [&](bool can_be, const auto& from, auto& to) {
        if (can_be) to = from;
        all = all && can_be;
    };
    take(is_within(found.sun_world_m, kFarthestSun_m), found.sun_world_m, kept.sun_world_m);
    take(is_possible(found.origin_from_barycenter), found.origin_from_barycenter,
         kept.origin_from_barycenter);
    for (std::size_t i = 0; i < kMaxBodies; ++i) {
        const BodyState& body = found.body[i];
        const Mat3d& axes = body.fixed_from_world;
        const bool can_be = is_within(body.world_m, kFarthestApart_m) && is_finite(axes.x) &&
                            is_finite(axes.y) && is_finite(axes.z) &&
                            is_within(body.velocity_m_s, kFastestMotion_m_s);
        take(can_be, body, kept.body[i]);
    }
    return all;
}

}  // namespace hilcam
