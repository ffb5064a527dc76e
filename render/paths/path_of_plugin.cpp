#include "render/paths/path_of_plugin.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "render/primary/primary_hits.h"
#include "render/shading/radiance_model.h"
#include "render/shading/shadow_rays.h"

namespace hilcam {
namespace {

// The scattering of a shading point as the plug-in sees it.
struct Scattering {
    const ShadingPoint* at;
    Bsdf surface;      // a narrow facet lobe becomes a mirror
    bool narrowed;     // it has such a lobe
    float lobe_share;  // albedo of the lobe relative to that of the mirror that replaces it
};
const Scattering& scattering_of(const PathPoint& at) { return *static_cast<const Scattering*>(at.inside); }

float lobe_share(const Bsdf& at, float no) {
    const LobeAlbedo* const facets = facets_of(*at.material);
    if (!facets) return 1;
    const auto* const dielectric = std::get_if<brdf::Dielectric>(&at.material->brdf);
    return (*facets)(no) / (dielectric ? fresnel_dielectric(dielectric->refractive_index, no) : 1.0f);
}

float view_cosine(const ShadingPoint& at) { return std::max(dot(at.normal, at.view_dir), 1e-4f); }

Scattering scattering_at(const ShadingPoint& at, float narrowest_alpha) {
    Scattering out{&at, at.surface, at.surface.alpha > 0 && at.surface.alpha < narrowest_alpha, 1};
    if (!out.narrowed) return out;
    out.lobe_share = lobe_share(at.surface, view_cosine(at));
    out.surface.alpha = 0;
    return out;
}

PathPoint shown(const Scattering& scattering) {
    const ShadingPoint& at = *scattering.at;
    return {.point_m = at.point_m,
            .geometric_normal = at.geometric_normal,
            .normal = at.normal,
            .view_dir = at.view_dir,
            .throughput = at.throughput,
            .samples = at.weight_samples,
            .pixel = at.pixel,
            .depth = at.depth,
            .scatters = scattering.surface.has_lobes(),
            .inside = &scattering};
}

// Shading points that are lit together, and the plug-in's view of them.
template <std::size_t kMax>
struct LitTogether {
    std::array<ShadingPoint, kMax> points;
    std::array<Scattering, kMax> scattering;
    std::array<PathPoint, kMax> seen;

    std::span<const PathPoint> show(std::size_t count, float narrowest_alpha) {
        for (std::size_t i = 0; i < count; ++i) {
            scattering[i] = scattering_at(points[i], narrowest_alpha);
            seen[i] = shown(scattering[i]);
        }
        return {seen.data(), count};
    }
};

// The view that a plug-in has of the tiles, one at a time.
class TileView final : public PathView {
  public:
    // Allocates for paths of this depth.
    void reserve_depth(int max_depth) {
        const auto levels = static_cast<std::size_t>(max_depth);
        if (levels_.size() < levels) levels_.resize(levels);
    }
    void trace(Tile& tile, PathPlugin& model) {
        tile_ = &tile;
        place_bodies();
        PrimaryHits seen(tile);
        while (const std::size_t count = seen.next(first_.points))
            model.light(*this, first_.show(count, model.narrowest_alpha()));
    }

    int max_depth() const override { return frame().max_depth; }
    float contribution_threshold() const override { return frame().contribution_threshold; }
    bool in_air() const override { return frame().background->camera_in_air(); }
    std::span<const PathBody> bodies() const override { return {bodies_.data(), body_count_}; }

    Spectrum brdf(const PathPoint& at, Vec3f dir) const override {
        const float ni = dot(at.normal, dir);
        if (ni <= 0 || dot(at.geometric_normal, dir) <= 0) return {};
        const Scattering& scattering = scattering_of(at);
        return brdf_value(scattering.surface, {view_cosine(*scattering.at), ni, dot(at.view_dir, dir)});
    }
    std::optional<PathDirection> exact_direction(const PathPoint& at, int number) const override {
        const Scattering& scattering = scattering_of(at);
        return direction_of(at, brdf_exact(scattering.surface, at.normal, at.view_dir, number));
    }
    std::optional<PathDirection> random_direction(const PathPoint& at) const override {
        const Scattering& scattering = scattering_of(at);
        const auto random = tile_->random_of(*scattering.at, 0);
        return direction_of(at,
                            brdf_sample(scattering.surface, at.normal, at.view_dir,
                                        {uniform01(random[0]), uniform01(random[1]), uniform01(random[2])}));
    }

    void add(const PathPoint& at, LightPart part, const Spectrum& light) override {
        tile_->add(*scattering_of(at).at, part, light);
    }
    void add_direct_light(std::span<const PathPoint> points) override {
        if (points.empty()) return;
        const ShadingPoint* const first = scattering_of(points.front()).at;
        frame().radiance->add_light(*tile_, {first, points.size()}, BodySampling::kNone);
    }
    void add_body_light(const PathPoint& at, std::span<const PathDirection> directions) override {
        const ShadingPoint& point = *scattering_of(at).at;
        const auto lit = [&](const PathDirection* from, const Spectrum* glass) {
            Spectrum weight = at.throughput * from->weight, light;
            if (glass) weight = weight * *glass;
            frame().background->add_bodies(point.start(), to_double(from->dir), weight, light);
            tile_->add(point, LightPart::kPlanetshine, light);
        };
        ShadowRays<const PathDirection*, decltype(lit)> shadow(frame(), tile_->stats.lamp_rays, lit);
        for (const PathDirection& from : directions) shadow.add(point.start(), from.dir, &from);
    }
    void follow(const PathPoint& at, std::span<const PathRay> rays, PathPlugin& model) override {
        HILCAM_CHECK(rays.size() <= kMaxRays);
        Spectrum nobodys;
        Spectrum& pixel = tile_->pixels[at.pixel];
        Spectrum& part = tile_->parts ? tile_->parts->of(LightPart::kPath)[at.pixel] : nobodys;
        const Spectrum before = std::exchange(pixel, {}), part_before = std::exchange(part, {});
        if (const std::size_t met = trace_rays(at, rays); met > 0)
            model.light(*this, level_behind(at).show(met, model.narrowest_alpha()));
        pixel += before, part += part_before;
    }

  private:
    using Level = LitTogether<kMaxRays>;
    Tile* tile_ = nullptr;
    LitTogether<PathModel::kMaxShadingPoints> first_;
    std::vector<Level> levels_;  // surfaces that rays have met, by the depth of the surface that they left
    std::array<PathBody, kMaxBodies> bodies_;
    std::size_t body_count_ = 0;

    const FrameContext& frame() const { return tile_->frame; }
    Level& level_behind(const PathPoint& at) { return levels_[static_cast<std::size_t>(at.depth - 1)]; }

    void place_bodies() {
        body_count_ = 0;
        for (const PlanetshineSource& body : frame().background->planetshine_sources())
            bodies_[body_count_++] = {to_float(body.world_dir), body.one_minus_cosine, body.cone_sine_squared,
                                      max_component(body.max_over_sun)};
    }

    std::optional<PathDirection> direction_of(const PathPoint& at, const BrdfSample& sample) const {
        if (!sample.valid || (!sample.transmits && dot(at.geometric_normal, sample.dir) <= 0)) return {};
        const Scattering& scattering = scattering_of(at);
        // Highlights of a lobe that was replaced by a mirror already include the Sun.
        return PathDirection{sample.dir, (sample.exact ? scattering.lobe_share : 1.0f) * sample.weight,
                             sample.exact, sample.transmits, sample.exact && !scattering.narrowed};
    }

    // Adds the light of rays that leave the scene, and stores what the others meet. Returns the number of the
    // latter.
    std::size_t trace_rays(const PathPoint& at, std::span<const PathRay> rays) {
        const ShadingPoint& from = *scattering_of(at).at;
        RayPacket packet;
        HitPacket hits;
        std::size_t met = 0;
        for (std::size_t first = 0; first < rays.size(); first += kPacketSize) {
            const std::span<const PathRay> some =
                rays.subspan(first, std::min<std::size_t>(kPacketSize, rays.size() - first));
            packet.count = static_cast<int>(some.size());
            for (std::size_t i = 0; i < some.size(); ++i)
                packet.set(static_cast<int>(i), from.start(!some[i].below), some[i].dir, 0,
                           std::numeric_limits<float>::infinity());
            frame().scene->intersect(packet, Coherence::kIncoherent, hits);
            tile_->stats.secondary_rays += some.size();
            for (std::size_t i = 0; i < some.size(); ++i) {
                if (hits.object[i] == HitPacket::kMiss)
                    add_background(from, some[i]);
                else if (at.depth < frame().max_depth &&
                         make_point(from, some[i], hits, static_cast<int>(i), level_behind(at).points[met]))
                    ++met;
            }
        }
        return met;
    }

    bool make_point(const ShadingPoint& from, const PathRay& ray, const HitPacket& hits, int lane,
                    ShadingPoint& point) const {
        if (!make_shading_point(frame(), hits, lane, from.start(!ray.below), ray.dir, 0,
                                {from.footprint_m, ray.spread_rad}, point))
            return false;
        point.pixel = from.pixel, point.sample = from.sample, point.moments = from.moments;
        point.depth = static_cast<std::uint16_t>(from.depth + 1);
        point.throughput = ray.throughput;
        point.ray_part = from.depth > 1 ? from.ray_part : ray.part;
        point.weight_samples = from.weight_samples;
        return true;
    }

    void add_background(const ShadingPoint& from, const PathRay& ray) {
        const Background& background = *frame().background;
        Spectrum weight = ray.throughput, light;
        const bool met = ray.sees_bodies &&
                         background.add_bodies(from.start(!ray.below), to_double(ray.dir), weight, light);
        if (!met && ray.sees_sun) background.add_sun_disk(to_double(ray.dir), weight, light);
        tile_->add(from, ray.background_part, light);
    }
};

class PathOfPlugin final : public PathModel {
  public:
    explicit PathOfPlugin(std::unique_ptr<PathPlugin> model) : model_(std::move(model)) {}

    void trace(Tile& tile) override {
        view_.reserve_depth(tile.frame.max_depth);
        view_.trace(tile, *model_);
    }
    void reserve_depth(int max_depth) override { view_.reserve_depth(max_depth); }

  private:
    std::unique_ptr<PathPlugin> model_;
    TileView view_;
};

}  // namespace

std::unique_ptr<PathModel> make_path_of_plugin(std::unique_ptr<PathPlugin> model) {
    return std::make_unique<PathOfPlugin>(std::move(model));
}

}  // namespace hilcam
