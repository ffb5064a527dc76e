#include "emulator/campaign/optical_flow.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "emulator/campaign/keypoints.h"

namespace hilcam {
namespace {

// Camera axes of the first picture into those of the second, carried by a thing.
struct Carried {
    Mat3d turn;
    Vec3d shift_m;
};

Carried carried_by(const SeenThing& before, const SeenThing& after) {
    const Mat3d turn = to_matrix(after.camera_from_thing) * transposed(to_matrix(before.camera_from_thing));
    return {turn, after.position_camera_m - turn * before.position_camera_m};
}

std::map<std::uint32_t, Carried> carried_things(const FrameTruth& from, const FrameTruth& to) {
    std::map<std::uint32_t, Carried> out;
    for (const SeenThing& before : from.things)
        for (const SeenThing& after : to.things)
            if (before.id == after.id && before.id != kSunId) out[before.id] = carried_by(before, after);
    return out;
}

}  // namespace

FlowImage optical_flow(const FrameTruth& from, const FrameTruth& to) {
    const FrameRaster& raster = from.raster;
    FlowImage flow(raster.width_px, raster.height_px, 2);
    const auto things = carried_things(from, to);
    // The sky, and the Sun with it.
    const Mat3d sky =
        transposed(to_matrix(to.camera.world_from_body)) * to_matrix(from.camera.world_from_body);
    for (int y = 0; y < raster.height_px; ++y) {
        const auto ids = from.layers.object.row(y);
        const auto px = from.layers.position_m.row(y, 0), py = from.layers.position_m.row(y, 1),
                   pz = from.layers.position_m.row(y, 2);
        for (int x = 0; x < raster.width_px; ++x) {
            const auto i = static_cast<std::size_t>(x);
            const Vec2d here{x + 0.5, y + 0.5};
            const auto thing = things.find(ids[i]);
            Vec3d at;
            if (thing != things.end()) {
                const Vec3d place_m{static_cast<double>(px[i]), static_cast<double>(py[i]),
                                    static_cast<double>(pz[i])};
                at = thing->second.turn * place_m + thing->second.shift_m;
            } else {
                const Vec2d image_px = raster.image_px(here);
                at = sky * from.geometry.direction_camera(image_px.x, image_px.y);
            }
            Vec2d there;
            const bool known = is_finite(at) && project_to_frame(to, at, there);
            flow.row(y, 0)[i] = known ? static_cast<float>(there.x - here.x) : kUnknownFlow_px;
            flow.row(y, 1)[i] = known ? static_cast<float>(there.y - here.y) : kUnknownFlow_px;
        }
    }
    return flow;
}

}  // namespace hilcam
