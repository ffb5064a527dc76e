#include "render/frame/find_side_light.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/shading/point_field.h"
#include "render/shading/shadow_rays.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr double kGoldenRatioOfTurn = 0.6180339887498949;
constexpr int kSunRings = 3, kSunSpokes = 8;

struct Axes {
    Vec3d along, side, up;
};
Axes axes_about(Vec3d along) {
    const Vec3d side =
        normalized(std::abs(along.x) < 0.9 ? cross(along, Vec3d{1, 0, 0}) : cross(along, Vec3d{0, 1, 0}));
    return {along, side, cross(along, side)};
}

// A narrow cone is a spot to any lens; the limb of a wide one may be just outside the picture.
std::size_t samples_of(double cone_cosine) {
    constexpr double kNarrow = 0.99985, kMiddle = 0.966;  // 1 and 15 degrees
    return cone_cosine > kNarrow ? 24 : cone_cosine > kMiddle ? 96 : 256;
}

// Dims `light` by objects between the sky and the camera.
bool passes_objects(const FrameContext& frame, Vec3d dir, Spectrum& light) {
    if (frame.objects->empty()) return true;
    const Vec3f start = frame.start_of(dir);
    RayPacket ray;
    ray.count = 1;
    ray.set(0, start, to_float(dir), 0, std::numeric_limits<float>::infinity());
    if (!frame.scene->occluded(ray)) return true;
    if (!frame.has_glass) return false;
    light = light * passed_through_glass(frame, start, to_float(dir));
    return max_component(light) > 0;
}

}  // namespace

void find_side_light(const FrameContext& frame, const WorldSnapshot& world, std::vector<SideLight>& lights) {
    const Background& sky = *frame.background;
    const PointField field(frame, world);
    const Mat3d camera_from_world = transposed(to_matrix(world.camera.world_from_body));
    const auto shown = [&](Vec3d dir) { return field.sees(dir, std::numeric_limits<double>::infinity()); };
    lights.clear();

    const Axes sun = axes_about(sky.sun_camera_dir());
    const double sine = std::sqrt(std::max(0.0, 1 - sky.sun_disk_cosine() * sky.sun_disk_cosine()));
    Spectrum whole;
    for (int ring = 0; ring < kSunRings; ++ring)
        whole +=
            sky.sun_disk().relative_radiance(static_cast<float>(std::sqrt(1 - (ring + 0.5) / kSunRings)));
    for (int ring = 0; ring < kSunRings; ++ring) {
        const double r = std::sqrt((ring + 0.5) / kSunRings);
        const Spectrum share = sky.sun_disk().relative_radiance(static_cast<float>(std::sqrt(1 - r * r)));
        for (int spoke = 0; spoke < kSunSpokes; ++spoke) {
            const double phi = 2 * kPi * (spoke + kGoldenRatioOfTurn * ring) / kSunSpokes;
            const Vec3d there = normalized(sun.along + (r * sine * std::cos(phi)) * sun.side +
                                           (r * sine * std::sin(phi)) * sun.up);
            const auto [dir, spread] = sky.seen_through_air(there, std::numeric_limits<double>::infinity());
            if (shown(dir)) continue;
            Spectrum light = static_cast<float>(spread) * sky.sun_clear_irradiance_w_m2_um(), ignored;
            for (int b = 0; b < frame.bins; ++b) light[b] *= share[b] / (whole[b] * kSunSpokes);
            if (sky.add_bodies_seen(dir, light, ignored) || !passes_objects(frame, dir, light)) continue;
            lights.push_back({to_float(camera_from_world * dir), light});
        }
    }

    for (const PlacedBody& body : sky.disks()) {
        const Axes axes = axes_about(body.world_dir);
        const std::size_t count = samples_of(body.cone_cosine), first = lights.size();
        const double each_sr = 2 * kPi * (1 - body.cone_cosine) / static_cast<double>(count);
        if (first + count > kMaxSideLights) break;
        lights.resize(first + count);
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 16), [&](const auto& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                // Uniform in the cosine, turned by the golden section: uniform over the cone.
                const double u = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
                const double one_minus = u * (1 - body.cone_cosine);
                const double s = std::sqrt(one_minus * (2 - one_minus));
                const double phi = 2 * kPi * kGoldenRatioOfTurn * static_cast<double>(i);
                const Vec3d dir = (1 - one_minus) * axes.along + (s * std::cos(phi)) * axes.side +
                                  (s * std::sin(phi)) * axes.up;
                SideLight& light = lights[first + i];
                light = {};
                const Background::BodyMet met = sky.first_body_seen(dir);
                if (shown(dir) || (met.body && met.body->id != body.id)) continue;
                Spectrum weight;
                weight.bin.fill(static_cast<float>(each_sr));
                Spectrum radiance;
                sky.add_bodies_seen(dir, weight, radiance);
                // A body of few pixels is dark to such rays; the air in front dims the rest.
                if (body.in_points) radiance += weight * sky.ground_radiance(body, dir);
                if (!(max_component(radiance) > 0) || !passes_objects(frame, dir, radiance)) continue;
                light = {to_float(camera_from_world * dir), radiance};
            }
        });
    }
    lights.erase(
        std::remove_if(lights.begin(), lights.end(),
                       [](const SideLight& l) { return !(max_component(l.irradiance_w_m2_um) > 0); }),
        lights.end());
}

}  // namespace hilcam
