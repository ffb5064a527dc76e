#include "render/frame/truth_rays.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/shading/shading_point.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr float kNoEnd = std::numeric_limits<float>::infinity();

}  // namespace

TruthRays::TruthRays(const FrameSetup& setup)
    : setup_(setup),
      frame_(setup.frame()),
      pixel_rad_(static_cast<float>(1 / setup.frame().geometry.focal_length_px)) {}

// Directions become unit vectors.
void TruthRays::generate(std::span<const Vec2d> points_px, std::span<CameraRay> rays) const {
    HILCAM_CHECK(points_px.size() <= static_cast<std::size_t>(kPacketSize));
    std::array<Vec2d, kPacketSize> padded;
    const double guard_px = frame_.geometry.guard_px;
    for (std::size_t k = 0; k < points_px.size(); ++k)
        padded[k] = {points_px[k].x + guard_px, points_px[k].y + guard_px};
    frame_.rays->generate({padded.data(), points_px.size()}, rays);
    for (CameraRay& ray : rays) ray.dir = normalized(ray.dir);
}

void TruthRays::trace(std::span<const Vec2d> points_px, bool normals, std::span<RayMet> met) const {
    const std::size_t count = points_px.size();
    std::array<CameraRay, kPacketSize> rays;
    generate(points_px, std::span(rays).first(count));
    std::array<Vec3f, kPacketSize> starts, dirs;
    RayPacket packet;
    packet.count = static_cast<int>(count);
    for (std::size_t k = 0; k < count; ++k) {
        starts[k] = frame_.start_of(rays[k].dir, rays[k].from_camera_m);
        dirs[k] = to_float(rays[k].dir);
        packet.set(static_cast<int>(k), starts[k], dirs[k], 0, kNoEnd);
    }
    HitPacket hits;
    frame_.scene->intersect(packet, Coherence::kCoherent, hits);
    for (std::size_t k = 0; k < count; ++k) {
        RayMet& out = met[k];
        out = {};
        const Vec3d dir = rays[k].dir;
        if (hits.object[k] != HitPacket::kMiss) {
            const Vec3d point_m =
                to_double(starts[k]) + static_cast<double>(hits.distance[k]) * to_double(dirs[k]);
            out.from_camera_m = point_m - frame_.camera_m;
            // The picture decides in the same way (primary_rays.cpp).
            if (!frame_.bodies_may_hide || !frame_.background->hides_seen(dir, length(out.from_camera_m))) {
                out.kind = RayMet::Kind::kObject;
                out.index = hits.object[k];
                out.range_m = length(out.from_camera_m - rays[k].from_camera_m);
                ShadingPoint point;
                if (normals && make_shading_point(frame_, hits, static_cast<int>(k), starts[k], dirs[k], 0,
                                                  {0, pixel_rad_}, point))
                    out.normal_dir = to_double(point.normal);
                continue;
            }
            out.from_camera_m = {};
        }
        // Bodies are seen from the camera's place at the frame's time, as in the picture.
        if (const Background::BodyMet body = frame_.background->first_body_seen(dir); body.body) {
            out.kind = RayMet::Kind::kBody;
            out.index = static_cast<std::uint32_t>(body.body->id);
            out.range_m = body.distance;
            out.from_camera_m = body.distance * dir;
            if (normals) out.normal_dir = body.normal_world_dir;
        } else if (frame_.background->sees_sun_disk(dir)) {
            out.kind = RayMet::Kind::kSun;
            out.range_m = length(setup_.world().bodies.sun_world_m - setup_.world().camera.position_world_m);
            out.from_camera_m = out.range_m * dir;
        }
    }
}

std::uint32_t TruthRays::meets_object(std::span<const Vec2d> points_px, std::size_t object) const {
    const std::size_t count = points_px.size();
    std::array<CameraRay, kPacketSize> rays;
    generate(points_px, std::span(rays).first(count));
    const Pose& pose = setup_.world().objects[object];
    const Mat3d object_from_world = transposed(to_matrix(pose.world_from_body));
    const Vec3d camera_m =
        object_from_world * (setup_.world().camera.position_world_m - pose.position_world_m);
    RayPacket packet;
    packet.count = static_cast<int>(count);
    for (std::size_t k = 0; k < count; ++k) {
        const Vec3d dir = object_from_world * rays[k].dir;
        const Vec3d eye_m = camera_m + object_from_world * rays[k].from_camera_m;
        // Starts just in front of the object, so that the result is precise at any distance.
        const double before_m = std::max(0.0, -dot(eye_m, dir) - 1.01 * setup_.radius_m(object));
        packet.set(static_cast<int>(k), to_float(eye_m + before_m * dir), to_float(dir), 0, kNoEnd);
    }
    return frame_.scene->occluded_by(object, packet);
}

std::uint32_t TruthRays::meets_body(std::span<const Vec2d> points_px, const PlacedBody& body) const {
    const std::size_t count = points_px.size();
    std::array<CameraRay, kPacketSize> rays;
    generate(points_px, std::span(rays).first(count));
    std::uint32_t met = 0;
    for (std::size_t k = 0; k < count; ++k)
        if (intersect_ellipsoid(body.figure, body.camera_m, body.fixed_from_world * rays[k].dir) >= 0)
            met |= 1u << k;
    return met;
}

bool TruthRays::exists(Vec2d point_px) const {
    const ImageGeometry& g = frame_.geometry;
    if (g.distortion.none()) return true;
    // The rows of a scanning line are instants.
    const Vec2d at{point_px.x, frame_.rays->scan_line_time_s() > 0 ? g.center_px().y : point_px.y};
    const Vec2d back = g.project_px(g.direction_camera(at.x, at.y));
    constexpr double kSame_px = 1e-3;
    return std::abs(back.x - at.x) < kSame_px && std::abs(back.y - at.y) < kSame_px;
}

bool TruthRays::on_image(Vec2d p) const {
    return p.x >= 0 && p.y >= 0 && p.x < frame_.geometry.width_px && p.y < frame_.geometry.height_px;
}

std::uint32_t owner_of(const FrameTruth& truth, std::size_t object) {
    const std::vector<std::uint32_t>& owners = truth.request.thing_of_object;
    return owners.empty() ? static_cast<std::uint32_t>(object) : owners[object];
}

std::uint32_t id_of(const FrameTruth& truth, const RayMet& met) {
    switch (met.kind) {
        case RayMet::Kind::kObject:
            return 1 + owner_of(truth, met.index);
        case RayMet::Kind::kBody:
            return truth_id(static_cast<BodyId>(met.index));
        case RayMet::Kind::kSun:
            return kSunId;
        case RayMet::Kind::kSky:
            break;
    }
    return kSkyId;
}

}  // namespace hilcam
