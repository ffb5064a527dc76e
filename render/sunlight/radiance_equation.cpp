#include "render/sunlight/radiance_equation.h"

#include <algorithm>
#include <cmath>

#include "render/brdf/microfacet.h"
#include "render/shading/lamp_light.h"
#include "render/shading/normal_clusters.h"
#include "render/shading/shadow_rays.h"
#include "render/sunlight/penumbra_sampler.h"

namespace hilcam {
namespace {

// The Sun's disk widens a highlight: its angular radius of 4.65 mrad turns facets by half of that, and slopes
// of independent causes add in quadrature.
float sun_widened(float alpha) { return std::min(1.0f, std::sqrt(alpha * alpha + 0.00233f * 0.00233f)); }

bool in_cone(const PlanetshineSource& lamp, Vec3f dir) {
    const Vec3f axis = to_float(lamp.world_dir);
    const Vec3f across = cross(axis, dir);
    return dot(axis, dir) > 0 && dot(across, across) <= lamp.cone_sine_squared;
}
float cone_density(const PlanetshineSource& lamp) {
    return 1 / (2 * kPiF * std::max(1e-20f, lamp.one_minus_cosine));
}

// True when the path's own next direction may meet the light as well.
bool is_weighed(const FrameContext& frame, const ShadingPoint& at) {
    return frame.paths_sample_lobes && !frame.is_cached[at.object] && at.depth < frame.max_depth;
}

// True when the whole body could add what the threshold asks for, relative to white paint in the Sun, and is
// above the surface's horizon.
bool body_light_counts(const FrameContext& frame, const ShadingPoint& at, const PlanetshineSource& lamp) {
    const float solid_angle = 2 * kPiF * lamp.one_minus_cosine;
    if (at.importance(at.throughput) * max_component(lamp.max_over_sun) * solid_angle <
        frame.contribution_threshold)
        return false;
    return dot(at.geometric_normal, to_float(lamp.world_dir)) >= -std::sqrt(lamp.cone_sine_squared);
}

Vec3f in_cone_at(const Frame& axis, float one_minus_cosine, float u1, float u2) {
    const float below = u1 * one_minus_cosine;  // 1 - z
    const float r = std::sqrt(below * (2 - below)), phi = 2 * kPiF * u2;
    return axis.to_world({r * std::cos(phi), r * std::sin(phi), 1 - below});
}

// Returns the density of the directions that are drawn to all bodies except one [sr^-1].
float density_of_others(const FrameContext& frame, const ShadingPoint& at, Vec3f dir,
                        const PlanetshineSource* one) {
    float density = 0;
    for (const PlanetshineSource& lamp : frame.background->planetshine_sources())
        if (&lamp != one && in_cone(lamp, dir) && body_light_counts(frame, at, lamp))
            density += cone_density(lamp);
    return density;
}

struct SunlitBy {
    const ShadingPoint* at;
    Spectrum weight;  // on the light that comes along dir
    Vec3f dir;
};

// The light of those shading points that have normal clusters, in order.
class ClusterLights {
  public:
    static constexpr std::size_t kMax = SunlitPoint::kMaxTogether;

    // shading points: kMax at most.
    void find(const FrameContext& frame, const SunSampler& sun, std::span<const ShadingPoint> points) {
        std::size_t count = 0;
        for (const ShadingPoint& at : points) {
            if (!at.clusters || !at.surface.has_lobes()) continue;
            const bool widened = !frame.sun_is_disk && at.cluster_alpha > 0;
            lights_[count] = {};
            sunny_[count++] = {&at, sun.of(at).dir,
                               widened ? sun_widened(at.cluster_alpha) : at.cluster_alpha};
        }
        lit_clusters(frame, std::span(sunny_).first(count), lights_);
        next_ = lights_.data();
    }
    const ClusterLight& next() { return *next_++; }

  private:
    std::array<SunlitPoint, kMax> sunny_;
    std::array<ClusterLight, kMax> lights_;
    const ClusterLight* next_ = nullptr;
};

void add_sunlight(Tile& tile, std::span<const ShadingPoint> points) {
    const FrameContext& frame = tile.frame;
    const Background& background = *frame.background;
    if (max_component(background.sun_irradiance_w_m2_um()) <= 0 || points.empty()) return;
    const SunSampler sun(tile);
    const bool primary = points.front().depth == 1;
    const bool finds_edges = primary && tile.penumbra && !frame.sun_is_disk && !frame.has_glass;

    const auto lit = [&](const SunlitBy& by, const Spectrum* glass) {
        tile.add(*by.at, LightPart::kSun, glass ? by.weight * *glass : by.weight);
    };
    TileStats& stats = tile.stats;
    std::uint64_t& counter = primary ? stats.shadow_rays : stats.bounce_shadow_rays;
    ShadowRays<SunlitBy, decltype(lit)> shadow(frame, counter, lit);
    ClusterLights of_facets;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (i % ClusterLights::kMax == 0)
            of_facets.find(frame, sun, points.subspan(i, std::min(ClusterLights::kMax, points.size() - i)));
        const ShadingPoint& at = points[i];
        if (!at.surface.has_lobes()) continue;
        const auto [dir, light] = sun.of(at);
        float share = at.sunlit;
        const float ni = dot(at.normal, dir);
        const Cosines c{std::max(dot(at.normal, at.view_dir), 1e-4f), ni, dot(at.view_dir, dir)};
        // Narrow lobes are better sampled by their own directions (Veach & Guibas, SIGGRAPH 95, balance
        // heuristic).
        if (frame.sun_is_disk && is_weighed(frame, at))
            share *= sun.disk_density() / (sun.disk_density() + brdf_density(at.surface, c));
        if (at.clusters) {
            const ClusterLight& sum = of_facets.next();
            if (sum.none()) continue;
            const Spectrum weight = share * (light * sum.reflected);
            if (finds_edges)
                tile.penumbra->add(at, weight, sum);
            else
                shadow.add(sum.brightest[0]->start_m, dir, {&at, weight, dir});
            continue;
        }
        if (ni <= 0 || dot(at.geometric_normal, dir) <= 0) continue;
        Bsdf surface = at.surface;
        if (!frame.sun_is_disk && surface.alpha > 0) surface.alpha = sun_widened(surface.alpha);
        const Spectrum weight = (ni * share) * (at.throughput * light * brdf_value(surface, c));
        if (!(max_component(weight) > 0) || (!frame.sun_is_disk && at.sun_visibility == SunVisibility::kDark))
            continue;
        if (!frame.sun_is_disk && at.sun_visibility == SunVisibility::kLit)
            tile.add(at, LightPart::kSun, weight);
        else if (finds_edges)
            tile.penumbra->add(at, weight);
        else
            shadow.add(at.start(), dir, {&at, weight, dir});
    }
    if (finds_edges) tile.penumbra->add_light(tile, sun);
}

// A random direction to each of the bodies, over its cone.
void add_body_light(Tile& tile, std::span<const ShadingPoint> points) {
    const FrameContext& frame = tile.frame;
    const Background& background = *frame.background;
    const auto lit = [&](const SunlitBy& by, const Spectrum* glass) {
        Spectrum weight = glass ? by.weight * *glass : by.weight;
        Spectrum light;
        background.add_bodies(by.at->start(), to_double(by.dir), weight, light);
        tile.add(*by.at, LightPart::kPlanetshine, light);
    };
    ShadowRays<SunlitBy, decltype(lit)> shadow(frame, tile.stats.lamp_rays, lit);
    std::uint32_t use = 2;
    for (const PlanetshineSource& lamp : background.planetshine_sources()) {
        const Frame axis(to_float(lamp.world_dir));
        ++use;
        for (const ShadingPoint& at : points) {
            if (!at.surface.has_lobes() || !body_light_counts(frame, at, lamp)) continue;
            const auto random = tile.random_of(at, use);
            const Vec3f dir =
                in_cone_at(axis, lamp.one_minus_cosine, uniform01(random[0]), uniform01(random[1]));
            const float ni = dot(at.normal, dir);
            if (ni <= 0 || dot(at.geometric_normal, dir) <= 0) continue;
            const Cosines c{std::max(dot(at.normal, at.view_dir), 1e-4f), ni, dot(at.view_dir, dir)};
            // Rounding may move a direction at a cone's edge out of the cone.
            const float density = cone_density(lamp) + density_of_others(frame, at, dir, &lamp) +
                                  (is_weighed(frame, at) ? brdf_density(at.surface, c) : 0);
            const Spectrum weight = (ni / density) * (at.throughput * brdf_value(at.surface, c));
            if (max_component(weight) > 0) shadow.add(at.start(), dir, {&at, weight, dir});
        }
    }
}

class RadianceEquation final : public RadianceModel {
  public:
    explicit RadianceEquation(bool emission) : emission_(emission) {}

    void add_light(Tile& tile, std::span<const ShadingPoint> points, BodySampling lamps) const override {
        if (tile.frame.has_emission)
            for (const ShadingPoint& at : points)
                tile.add(at, LightPart::kEmission,
                         at.throughput * at.surface.material->emission.towards(dot(at.normal, at.view_dir)));
        add_sunlight(tile, points);
        add_lamps_reflected(tile, points);
        if (lamps == BodySampling::kSampled) add_body_light(tile, points);
    }
    bool emits() const override { return emission_; }
    bool reflects_plainly() const override { return true; }

  private:
    bool emission_;
};

}  // namespace

std::unique_ptr<RadianceModel> make_radiance_equation(bool emission) {
    return std::make_unique<RadianceEquation>(emission);
}

float planetshine_density(const FrameContext& frame, const ShadingPoint& at, Vec3f dir) {
    return density_of_others(frame, at, dir, nullptr);
}

float sun_density(const FrameContext& frame, Vec3f dir) {
    if (!frame.sun_is_disk) return 0;
    const Vec3f across = cross(dir, to_float(frame.background->sun_world_dir()));
    const double cosine = frame.background->sun_disk_cosine();
    const auto sine_squared = static_cast<float>(1 - cosine * cosine);
    const bool inside =
        dot(across, across) <= sine_squared && dot(dir, to_float(frame.background->sun_world_dir())) > 0;
    return inside ? 1 / (kPiF * sine_squared) : 0.0f;
}

}  // namespace hilcam
