#include "render/shading/lamp_light.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/shading/shadow_rays.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr double kNearest_m = 1e-3;
constexpr double kNoDistance_m = 1e-9;

struct LitBy {
    const ShadingPoint* at;
    Spectrum weight;  // the light that arrives if nothing is in between
};

// Returns how far towards a lamp an obstacle is looked for. Single precision leaves an error of 6e-8 of the
// length and of the ends' coordinates; a millionth is a safe margin.
double free_length_m(double distance_m) { return std::max(0.0, (1 - 1e-6) * distance_m - kLampClearance_m); }

// True if an object hides it, including one that is drawn as points: a PointField tests those that are
// traced, and dims what is behind their glass.
bool is_hidden(const FrameContext& frame, Vec3d dir, double distance_m) {
    const Vec3f start_m = frame.start_of(dir);
    const double until_m = distance_m - length(to_double(start_m) - frame.camera_m);
    if (!(until_m > 0)) return false;
    RayPacket ray;
    ray.count = 1;
    ray.set(0, start_m, to_float(dir), 0, static_cast<float>(until_m));
    if (frame.scene->occluded(ray) == 0) return false;
    return !frame.has_glass ||
           !(max_component(passed_through_glass(frame, start_m, to_float(dir), ray.farthest[0])) > 0);
}

}  // namespace

bool PlacedLamp::shines_on(Vec3d place_m, LampRay& ray) const {
    const Vec3d to_lamp_m = position_m - place_m;
    ray.distance_m = length(to_lamp_m);
    if (!(ray.distance_m > kNoDistance_m)) return false;
    ray.dir = to_lamp_m / ray.distance_m;
    const double near_m = std::max(ray.distance_m, kNearest_m);
    ray.per_m2 = static_cast<float>(beam->at(axis, -ray.dir) / (near_m * near_m));
    return ray.per_m2 > 0;
}

Lamps::Lamps(std::vector<SceneLamp> lamps) : lamps_(std::move(lamps)) {
    if (lamps_.size() > kMaxLamps)
        throw refused("lamps", std::to_string(lamps_.size()), "at most " + std::to_string(kMaxLamps));
}

void Lamps::place(const WorldSnapshot& world, Vec3d ray_space_world_m) {
    HILCAM_CHECK(world.lamps.size() == lamps_.size());
    lit_count_ = 0;
    for (std::size_t i = 0; i < lamps_.size(); ++i) {
        const ShownLamp& shown = world.lamps[i];
        const Spectrum intensity = static_cast<float>(shown.level) * lamps_[i].intensity_w_sr_um;
        if (!(max_component(intensity) > 0)) continue;
        lit_[lit_count_++] = {i, shown.position_world_m - ray_space_world_m, shown.axis, intensity,
                              &lamps_[i].beam};
    }
}

void add_lamps_reflected(Tile& tile, std::span<const ShadingPoint> points) {
    const FrameContext& frame = tile.frame;
    if (!frame.lamps || frame.lamps->lit().empty()) return;
    const auto lit = [&](const LitBy& by, const Spectrum* glass) {
        tile.add(*by.at, LightPart::kLamps, glass ? by.weight * *glass : by.weight);
    };
    ShadowRays<LitBy, decltype(lit)> shadow(frame, tile.stats.lamp_rays, lit);
    for (const PlacedLamp& lamp : frame.lamps->lit())
        for (const ShadingPoint& at : points) {
            if (!at.surface.has_lobes()) continue;
            const Vec3f start_m = at.start();
            LampRay ray;
            if (!lamp.shines_on(to_double(start_m), ray)) continue;
            const Vec3f dir = to_float(ray.dir);
            const float ni = dot(at.normal, dir);
            if (ni <= 0 || dot(at.geometric_normal, dir) <= 0) continue;
            const Cosines c{std::max(dot(at.normal, at.view_dir), 1e-4f), ni, dot(at.view_dir, dir)};
            const Spectrum weight =
                (ni * ray.per_m2) * (at.throughput * lamp.intensity_w_sr_um * brdf_value(at.surface, c));
            if (max_component(weight) > 0)
                shadow.add(start_m, dir, {&at, weight}, static_cast<float>(free_length_m(ray.distance_m)));
        }
}

void add_lamps_seen(const FrameContext& frame, const PointField& field, std::vector<PointSource>& points) {
    if (!frame.lamps) return;
    for (const PlacedLamp& lamp : frame.lamps->lit()) {
        LampRay ray;
        if (!lamp.shines_on(frame.camera_m, ray)) continue;
        const double distance_m = free_length_m(ray.distance_m);
        if (!(distance_m > 0) || !field.sees(ray.dir, distance_m) || is_hidden(frame, ray.dir, distance_m))
            continue;
        const std::size_t thing = frame.lamps->all()[lamp.number].thing;
        field.add(ray.dir, distance_m, ray.per_m2 * lamp.intensity_w_sr_um, points,
                  thing == 0 ? PointSource::kSky : static_cast<std::uint32_t>(thing - 1));
    }
}

}  // namespace hilcam
