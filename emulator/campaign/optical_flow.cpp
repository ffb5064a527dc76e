#include "emulator/campaign/optical_flow.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "emulator/campaign/keypoints.h"

namespace hilcam {
namespace {

// Transforms camera axes of the first picture to those of the second for points carried by a thing.
struct Carried {
    Mat3d turn;
    Vec3d shift_m;
};

Carried carried(Quat camera_from_before, Vec3d before_m, Quat camera_from_after, Vec3d after_m) {
    const Mat3d turn = to_matrix(camera_from_after) * transposed(to_matrix(camera_from_before));
    return {turn, after_m - turn * before_m};
}

const Carried* find_in(const std::map<std::uint32_t, Carried>& all, std::uint32_t id) {
    const auto found = all.find(id);
    return found == all.end() ? nullptr : &found->second;
}

std::map<std::uint32_t, Carried> carried_things(const FrameTruth& from, const FrameTruth& to) {
    std::map<std::uint32_t, Carried> out;
    for (const SeenThing& before : from.things)
        for (const SeenThing& after : to.things)
            if (before.id == after.id && before.id != kSunId)
                out[before.id] = carried(before.camera_from_thing, before.position_camera_m,
                                         after.camera_from_thing, after.position_camera_m);
    return out;
}

// Returns the transforms by number of the renderer's object, from 1.
std::map<std::uint32_t, Carried> carried_parts(const FrameTruth& from, const FrameTruth& to) {
    std::map<std::uint32_t, Carried> out;
    for (const SeenPart& before : from.parts)
        for (const SeenPart& after : to.parts)
            if (before.object == after.object)
                out[1 + before.object] = carried(before.camera_from_part, before.position_camera_m,
                                                 after.camera_from_part, after.position_camera_m);
    return out;
}

}  // namespace

FlowImage optical_flow(const FrameTruth& from, const FrameTruth& to) {
    const FrameRaster& raster = from.raster;
    FlowImage flow(raster.width_px, raster.height_px, 2);
    const auto things = carried_things(from, to);
    const auto parts = carried_parts(from, to);
    const bool has_parts = !parts.empty() && from.layers.part.planes() > 0;
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
            const Carried* carrier = find_in(things, ids[i]);
            if (has_parts)
                if (const Carried* part = find_in(parts, from.layers.part.row(y)[i])) carrier = part;
            Vec3d at;
            if (carrier) {
                const Vec3d place_m{static_cast<double>(px[i]), static_cast<double>(py[i]),
                                    static_cast<double>(pz[i])};
                at = carrier->turn * place_m + carrier->shift_m;
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
