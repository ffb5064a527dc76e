// Looks up the cached light that shading points reflect (indirect_cache.h), and the unblocked direct light of
// bodies.

#include "render/indirect/indirect_cache.h"

#include <algorithm>
#include <cmath>

#include "render/brdf/microfacet.h"
#include "render/shading/lamp_light.h"

namespace hilcam {
namespace {

Vec3f to_body(const Mat3f& world_from_body, Vec3f world) { return transposed(world_from_body) * world; }

Spectrum ratio(const Spectrum& here, const Spectrum& own, float where_none = 1) {
    Spectrum out;
    for (int b = 0; b < kMaxBins; ++b) out[b] = own[b] > 0 ? here[b] / own[b] : where_none;
    return out;
}
// Returns the ratio of the place's spectrum to the material's own: for facets that have their own colours,
// and for the rest.
Spectrum facet_tint(const Bsdf& at) { return ratio(at.highlight, at.material->highlight); }
bool has_own_colors(const Bsdf& at) { return at.material->varies() && at.material->is_bare(); }
bool is_tinted(const Bsdf& at) { return at.base.bin != at.material->base.bin; }
// True when the diffuse part of a material scatters by a law other than Lambert's. Smooth metal counts as
// Lambert's: a hundredth of its light is diffuse, and is better off so where the body is hidden in part.
bool has_own_law(const Material& of) {
    constexpr float kSmoothMetal = 0.9f;  // albedo of the facets
    const LobeAlbedo* const facets = facets_of(of);
    return !of.transmits() && of.brdf.index() != kModel<brdf::Lambert> &&
           !(facets && facets->average > kSmoothMetal);
}
Spectrum base_tint(const Bsdf& at) { return ratio(at.base, at.material->base); }

// Lobes at least seven degrees wide treat directions within a degree as the same.
constexpr float kSameLobe = 0.9998f;  // cosine

// True when two shading points belong to one surface and have the same normal. A texture may still colour
// their facets differently.
bool lies_alike(const ShadingPoint& a, const ShadingPoint& b) {
    return a.object == b.object && a.surface_number == b.surface_number && a.back == b.back &&
           dot(a.normal, b.normal) > kSameLobe;
}
// True when they also have the same lobe and view direction.
bool sends_alike(const ShadingPoint& a, const ShadingPoint& b) {
    return lies_alike(a, b) && a.surface.alpha == b.surface.alpha && dot(a.view_dir, b.view_dir) > kSameLobe;
}
// Returns the number of the square of four pixels that sees a shading point; cached light is too smooth to
// differ inside it.
std::uint32_t quad_of(const Tile& tile, const ShadingPoint& at) {
    const auto width = static_cast<std::uint32_t>(tile.box.x1 - tile.box.x0);
    return at.pixel / width / 2 * width + at.pixel % width / 2;
}
// near_m: points closer than this receive the same light. Mirrors in different planes show different things.
bool is_alike(const ShadingPoint& a, const ShadingPoint& b, float near_m) {
    constexpr float kPlane = 0.999998f;  // cosine
    const bool mirror = a.surface.material->has_facets() && a.surface.alpha < kNarrowestLobe;
    const Vec3f apart_m = a.point_m - b.point_m;
    return lies_alike(a, b) && dot(apart_m, apart_m) < near_m * near_m &&
           (!mirror || dot(a.normal, b.normal) > kPlane);
}

}  // namespace

// True when something may be in the mirror direction.
bool IndirectCache::is_near(const FrameContext& frame, const Place& place) const {
    if (objects_.size() > 1 || !place.found || place.about.count == 0) return true;
    const ShadingPoint& at = *place.at;
    const Vec3f dir = to_body(frame.world_from_body[at.object], reflect(at.view_dir, at.normal));
    const IrradianceCache& light = *objects_[at.object].light;
    if (light.is_near(place.nearest, dir)) return true;
    // If one probe knows of something and the next does not, a bright lobe shows a step. Testing all probes
    // takes time.
    if (at.surface.alpha < kNarrowestLobe || max_component(lobe_albedo(at)) < kBrightLobe) return false;
    return std::any_of(place.about.probe.begin(),
                       place.about.probe.begin() + static_cast<std::ptrdiff_t>(place.about.count),
                       [&](std::uint32_t probe) { return light.is_near(probe, dir); });
}

// Returns the place whose light a shading point can share; null: it needs its own. For mirrors light from
// anywhere matters.
IndirectCache::Place* IndirectCache::shared_place(std::span<Place> places, const ShadingPoint& at,
                                                  std::uint32_t quad) const {
    const float near_m = 0.5f * objects_[at.object].light->table().probes().cube_m();
    for (auto place = places.rbegin(); place != places.rend(); ++place) {
        if (place->quad != quad) return nullptr;
        if (is_alike(*place->at, at, near_m) && (at.depth == 1 || sends_alike(*place->at, at)))
            return &*place;
    }
    return nullptr;
}

void IndirectCache::add_reflected(Tile& tile, std::span<const ShadingPoint> points,
                                  std::span<GlossyRequest> requests) const {
    if (points.empty()) return;
    Together block;
    for (std::size_t first = 0; first < points.size();) {
        const std::size_t end = gather(tile, points, first, block);
        std::fill(requests.begin() + static_cast<std::ptrdiff_t>(first),
                  requests.begin() + static_cast<std::ptrdiff_t>(end), GlossyRequest{});
        first = end;
        const std::span<Place> places(block.places.data(), block.place_count);
        find(tile.frame, places);
        for (Place& place : places)
            if (is_lit(place)) place.diffuse = reflect_diffuse(tile.frame, place);
        for (Place& place : places) reflect_clusters(tile.frame, place);
        for (const Use& use : std::span(block.uses.data(), block.use_count)) add_use(tile, use, requests);
    }
}

// Takes as many shading points as fit, from the first on. Returns the number of the next one.
std::size_t IndirectCache::gather(const Tile& tile, std::span<const ShadingPoint> points, std::size_t first,
                                  Together& block) const {
    std::size_t next = first, &count = block.place_count, &used = block.use_count;
    count = used = 0;
    for (; next < points.size() && count < block.places.size() && used < block.uses.size(); ++next) {
        const ShadingPoint& at = points[next];
        if (at.surface.is_glass()) continue;
        const std::uint32_t quad = quad_of(tile, at);
        Place* place = tile.seen ? shared_place({block.places.data(), count}, at, quad) : nullptr;
        if (!place) place = &block.places[count++], place->at = &at, place->quad = quad;
        block.uses[used++] = {&at, static_cast<std::uint32_t>(next), place};
    }
    return next;
}

void IndirectCache::reflect_clusters(const FrameContext& frame, Place& place) const {
    const ShadingPoint& at = *place.at;
    place.met = {}, place.bodies = {}, place.unhidden = {}, place.free = {}, place.directions = 0;
    place.mirrors_near = true, place.has_bodies = false;
    if (!at.surface.material->has_facets()) return;
    if (at.surface.alpha < kMinCachedAlpha) place.mirrors_near = is_near(frame, place);
    if (at.surface.alpha >= kNarrowestLobe && is_lit(place)) reflect_lobe(frame, place);
    if (at.surface.alpha < kNarrowestLobe) reflect_far_bodies(place);
}

// Adds the shading point's share of its place's light to its pixel, or leaves its lobe to rays.
void IndirectCache::add_use(Tile& tile, const Use& use, std::span<GlossyRequest> requests) const {
    const ShadingPoint& at = *use.at;
    const Place& place = *use.place;
    GlossyRequest& request = requests[use.number];
    request.mirrors_near = place.mirrors_near;
    request.has_bodies = place.has_bodies;
    if (!is_lit(place)) return;
    const Bsdf& surface = at.surface;
    Spectrum reflected = place.diffuse;
    if (is_tinted(surface)) reflected = base_tint(surface) * reflected;
    Spectrum met, bodies;  // light of other surfaces and of bodies in the lobe
    if (surface.material->has_facets()) {
        met = has_own_colors(surface) ? lobe_albedo(at) * place.met : place.met;
        request.point = leave_to_rays(tile, at, place, met);
        if (request.point)
            met = {};
        else
            bodies = sum_of_bodies(at, place.bodies), reflected += met + bodies;
    }
    tile.add(at, LightPart::kDiffuse, at.throughput * reflected);
    if (!tile.parts) return;
    Spectrum planetshine = reflect_bodies(place);
    if (is_tinted(surface)) planetshine = base_tint(surface) * planetshine;
    tile.move(at, LightPart::kDiffuse, LightPart::kPlanetshine, at.throughput * (planetshine + bodies));
    tile.move(at, LightPart::kDiffuse, LightPart::kGlossy, at.throughput * met);
}

// Returns the weight of rays, 0 to 1. Rays follow the lobes of what the camera sees if near things may show
// in them: if the light that they bring to the pixel exceeds half the threshold, relative to white paint in
// the Sun. From there to the full threshold rays gain weight against the cache, so that no edge shows where
// they begin.
float IndirectCache::share_of_rays(const Tile& tile, const ShadingPoint& at, const Place& place,
                                   const Spectrum& met) const {
    constexpr float kOfThreshold = 0.5f, kOfFree = 4;
    if (!tile.glossy || at.depth != 1 || tile.frame.max_depth < 2 || at.surface.alpha < kNarrowestLobe)
        return 0;
    // A table's directions may miss a narrow lobe, so rays search it.
    if (at.surface.alpha < kMinCachedAlpha && place.mirrors_near)
        return at.importance(at.throughput * lobe_albedo(at)) >= tile.frame.contribution_threshold ? 1.0f
                                                                                                   : 0.0f;
    float light = max_component(met);
    for (std::size_t b = 0; b < planetshine_.bodies().size(); ++b)
        light += std::min(1.0f, kOfFree * (1 - place.free[b])) *
                 max_component(colored(at.surface, place.unhidden[b]));
    const float least = kOfThreshold * tile.frame.contribution_threshold *
                        tile.white_paint(tile.frame.background->sun_irradiance_w_m2_um());
    return light > 0 ? std::clamp(at.weight_samples * light / least - 1, 0.0f, 1.0f) : 0.0f;
}

// Null: the cache has the lobe's light.
GlossyPoint* IndirectCache::leave_to_rays(Tile& tile, const ShadingPoint& at, const Place& place,
                                          const Spectrum& met) const {
    const float share = share_of_rays(tile, at, place, met);
    GlossyPoint* const point = share > 0 ? tile.glossy->add_point() : nullptr;
    if (!point) return nullptr;
    point->point_m = at.point_m, point->normal = at.normal, point->view_dir = at.view_dir;
    point->geometric_normal = at.geometric_normal;
    point->alpha = at.surface.alpha, point->footprint_m = at.footprint_m;
    point->object = at.object, point->surface = at.surface_number, point->back = at.back;
    point->pixel = at.pixel, point->triangle = at.triangle, point->moments = at.moments;
    point->weight_samples = at.weight_samples, point->samples = at.samples;
    point->weight = at.throughput * lobe_albedo(at);
    point->cached = at.throughput * met;
    for (std::size_t b = 0; b < point->bodies.size(); ++b)
        point->bodies[b] = at.throughput * colored(at.surface, place.unhidden[b]),
        point->free[b] = place.free[b];
    point->directions = place.directions, point->share = share;
    point->probes_apart_m = objects_[at.object].light->table().probes().cube_m();
    return point;
}

void IndirectCache::find(const FrameContext& frame, std::span<Place> places) const {
    for (Place& place : places) {
        const ShadingPoint& at = *place.at;
        const Mat3f& axes = frame.world_from_body[at.object];
        const Object& object = objects_[at.object];
        place.search = object.light->table().probes().begin(
            to_body(axes, at.point_m - object.origin_m),
            {to_body(axes, at.geometric_normal), at.surface_number, at.back});
    }
    for (Place& place : places) objects_[place.at->object].light->table().probes().open(place.search);
    for (Place& place : places) {
        const ShadingPoint& at = *place.at;
        const IrradianceCache& light = *objects_[at.object].light;
        place.found = light.table().probes().finish(place.search, place.about);
        if (place.about.count == 0) continue;
        place.nearest = place.about.nearest();
        light.prefetch(place.about);
        if (at.surface.material->has_facets()) light.prefetch_lobe(place.nearest);
    }
}

// Returns the irradiance of all sources except the Sun by way of other surfaces, at a probe or about a place.
template <class Where>
Spectrum IndirectCache::others(const FrameContext& frame, const IrradianceCache& light,
                               const Where& where) const {
    Spectrum sum;
    for (std::size_t b = 0; b < planetshine_.bodies().size(); ++b)
        sum += planetshine_.bodies()[b].irradiance_w_m2_um *
               light.irradiance(RadiosityTerms::kBodies + b, where);
    if (frame.lamps)
        for (const PlacedLamp& lamp : frame.lamps->lit())
            sum += lamp.intensity_w_sr_um * light.irradiance(RadiosityTerms::kLamps + lamp.number, where);
    if (terms_.emission) sum += light.irradiance(terms_.glow(), where);
    return sum;
}

// Returns the radiance that a surface of the material's own colour reflects without its facets.
Spectrum IndirectCache::reflect_diffuse(const FrameContext& frame, const Place& place) const {
    const ShadingPoint& at = *place.at;
    const Object& object = objects_[at.object];
    const IrradianceCache& light = *object.light;
    const ProbeWeights& about = place.about;
    const Spectrum& sun = frame.background->sun_irradiance_w_m2_um();
    const bool sunlit = max_component(sun) > 0;
    if (at.surface.material->has_facets() && at.surface.alpha >= kNarrowestLobe && place.found)
        light.prefetch_along(sunlit ? RadiosityTerms::kSun : IrradianceCache::kNoTerm, place.nearest);

    Spectrum all = others(frame, light, about);
    if (sunlit) all += sun * light.irradiance(RadiosityTerms::kSun, about);
    return radiance_of(place, all) + reflect_bodies(place);
}

// Returns the unblocked direct irradiance of a body at a place.
Spectrum IndirectCache::direct_irradiance(std::size_t body, const Place& place) const {
    const IrradianceCache& light = *objects_[place.at->object].light;
    return (place.found ? light.seen(RadiosityTerms::kBodies + body, place.about) : 1.0f) *
           planetshine_.irradiance(body, place.at->normal);
}

// Returns the diffuse radiance that a body's direct light makes. The light comes from a part of the sky, and a
// rough surface sends more of it back to where it came from. So the surface's law is summed over the parts of
// the body, and the sum is scaled to the irradiance. With the albedo alone, white paint is 6 % too dark if the
// Earth is behind the camera.
Spectrum IndirectCache::reflect_body(std::size_t body, const Place& place) const {
    const ShadingPoint& at = *place.at;
    const Spectrum irradiance = direct_irradiance(body, place);
    if (!has_own_law(*at.surface.material)) return radiance_of(place, irradiance);
    Bsdf plain = at.surface;  // add_use() adds the colours of textures
    plain.base = plain.material->base;
    const float no = std::max(dot(at.normal, at.view_dir), 1e-4f);
    Spectrum sent, met;
    planetshine_.for_each_part(body, [&](Vec3f dir, const Spectrum& facing) {
        const float ni = dot(at.normal, dir);
        if (!(ni > 0)) return;
        met += ni * facing;
        sent += ni * facing * brdf_diffuse_value(plain, {no, ni, dot(at.view_dir, dir)});
    });
    return max_component(met) > 0 ? ratio(sent, met, 0) * irradiance : radiance_of(place, irradiance);
}

// Returns the part of reflect_diffuse() that is direct light of bodies.
Spectrum IndirectCache::reflect_bodies(const Place& place) const {
    Spectrum all;
    for (std::size_t b = 0; b < planetshine_.bodies().size(); ++b) all += reflect_body(b, place);
    return all;
}

// Returns the radiance that a surface of the material's own colour reflects of an irradiance, without its
// facets.
Spectrum IndirectCache::radiance_of(const Place& place, const Spectrum& irradiance) const {
    const ShadingPoint& at = *place.at;
    const float no = std::max(dot(at.normal, at.view_dir), 1e-4f);
    return (1 / kPiF) * (objects_[at.object].light->albedo(at.surface_number).base(no) * irradiance);
}

void IndirectCache::reflect_lobe(const FrameContext& frame, Place& place) const {
    const ShadingPoint& at = *place.at;
    // If something is near, rays find the bodies in the middle of a narrow lobe. If not, the lobe has all of
    // them.
    const bool narrow = at.surface.alpha < kMinCachedAlpha, whole = narrow && !place.mirrors_near;
    const float share = narrow && !whole ? tail_share(at.surface.alpha) : 1.0f;
    const MetByLobe met = met_by_lobe(frame, place, whole);
    place.met = met.radiance, place.directions = met.directions;
    place.unhidden = sent_of_bodies(at), place.free = met.free;
    for (std::size_t b = 0; b < planetshine_.bodies().size(); ++b)
        place.bodies[b] = {(share * met.free[b]) * place.unhidden[b].radiance,
                           place.unhidden[b].facet_cosine};
}

// A mirror that shows no body and has nothing near sees bodies only by its lobe's tails, which four pixels
// share.
void IndirectCache::reflect_far_bodies(Place& place) const {
    const ShadingPoint& at = *place.at;
    const Vec3f mirror = reflect(at.view_dir, at.normal);
    place.has_bodies = !place.mirrors_near && is_lit(place) && dot(at.geometric_normal, mirror) > 0 &&
                       planetshine_.is_clear_of_bodies(mirror);
    if (place.has_bodies) place.bodies = sent_of_bodies(at);
}

std::optional<std::uint32_t> IndirectCache::nearest_probe(const FrameContext& frame, std::size_t object,
                                                          Vec3f point_m, const SurfaceSide& side) const {
    const Mat3f& axes = frame.world_from_body[object];
    SurfaceSide in_body = side;
    in_body.geometric_normal = to_body(axes, side.geometric_normal);
    ProbeWeights about;
    const Object& cached = objects_[object];
    const bool found =
        cached.light->table().probes().find(to_body(axes, point_m - cached.origin_m), in_body, about);
    if (!found || about.count == 0) return std::nullopt;
    return about.nearest();
}

IndirectCache::MetByLobe IndirectCache::met_by_lobe(const FrameContext& frame, const Place& place,
                                                    bool whole) const {
    const ShadingPoint& at = *place.at;
    const IrradianceCache& light = *objects_[at.object].light;
    const Spectrum& sun = frame.background->sun_irradiance_w_m2_um();
    const bool sunlit = max_component(sun) > 0;
    const std::size_t bodies = planetshine_.bodies().size();
    IrradianceCache::Lobe lobe;
    if (place.found) {
        const Mat3f& axes = frame.world_from_body[at.object];
        std::array<IrradianceCache::Cone, Planetshine::kMaxBodies> cones;
        for (std::size_t b = 0; b < bodies; ++b)
            cones[b] = {to_body(axes, planetshine_.bodies()[b].light_dir),
                        planetshine_.bodies()[b].light_cosine};
        lobe = light.lobe(sunlit ? RadiosityTerms::kSun : IrradianceCache::kNoTerm,
                          {cones.data(), whole ? 0 : bodies}, place.nearest, to_body(axes, at.normal),
                          to_body(axes, at.view_dir), at.surface.alpha);
    }
    Spectrum radiance;
    if (lobe.of_irradiance > 0) radiance += lobe.of_irradiance * others(frame, light, place.nearest);
    if (sunlit) radiance += sun * lobe.cached;
    if (!has_own_colors(at.surface)) radiance = lobe_albedo(at) * radiance;
    return {radiance, lobe.free, lobe.directions};
}

Spectrum IndirectCache::lobe_albedo(const ShadingPoint& at) const {
    const float no = std::max(dot(at.normal, at.view_dir), 1e-4f);
    const Spectrum plain = objects_[at.object].light->albedo(at.surface_number).lobe(no);
    return has_own_colors(at.surface) ? facet_tint(at.surface) * plain : plain;
}

IndirectCache::SentOfBodies IndirectCache::sent_of_bodies(const ShadingPoint& at) const {
    SentOfBodies sent;
    // Brighter texels may share it.
    const float reflectance = has_own_colors(at.surface) ? 1.0f : max_component(lobe_albedo(at));
    for (std::size_t b = 0; b < planetshine_.bodies().size(); ++b)
        sent[b] =
            at.clusters ? sent_by_parts(b, at, reflectance) : sent_of_body(b, at, at.normal, reflectance);
    return sent;
}

// Returns a body's whole light in a facet lobe, without the colour of facets that have their own.
// reflectance: of the lobe.
Planetshine::Glossy IndirectCache::sent_of_body(std::size_t body, const ShadingPoint& at, Vec3f normal,
                                                float reflectance) const {
    Planetshine::Glossy sent = planetshine_.glossy(body, normal, at.view_dir, at.surface.alpha, reflectance);
    if (!has_own_colors(at.surface))
        sent.radiance = brdf_mirrored(at.surface, sent.facet_cosine) * sent.radiance;
    return sent;
}

// The same for a shading point with several normals, one by one: of two that differ one may show the body,
// and their mean nothing of it.
Planetshine::Glossy IndirectCache::sent_by_parts(std::size_t body, const ShadingPoint& at,
                                                 float reflectance) const {
    const bool own_colors = has_own_colors(at.surface);
    Spectrum sum;
    float samples = 0, cosines = 0;
    std::array<Planetshine::Glossy, Planetshine::Lobes::kMax> sent;
    for (const NormalCluster* part = at.clusters; part;) {
        Planetshine::Lobes lobes{at.view_dir, at.surface.alpha, reflectance};
        for (const NormalCluster* next = part; next && lobes.count < sent.size(); next = next->next)
            lobes.add(next->normal);
        planetshine_.glossy(body, lobes, sent);
        for (std::size_t i = 0; i < lobes.count; ++i, part = part->next) {
            const Spectrum white = sent[i].radiance;
            const Spectrum light =
                part->samples *
                (own_colors ? white : brdf_mirrored(at.surface, sent[i].facet_cosine) * white);
            sum += light, samples += part->samples;
            if (own_colors) cosines += max_component(light) * sent[i].facet_cosine;
        }
    }
    const float all = max_component(sum);
    return {(1 / samples) * sum, own_colors && all > 0 ? std::min(cosines / all, 1.0f) : 1.0f};
}

Spectrum IndirectCache::colored(const Bsdf& at, const Planetshine::Glossy& sent) {
    return has_own_colors(at) ? brdf_mirrored(at, sent.facet_cosine) * sent.radiance : sent.radiance;
}

Spectrum IndirectCache::sum_of_bodies(const ShadingPoint& at, const SentOfBodies& sent) const {
    Spectrum sum;
    for (std::size_t b = 0; b < planetshine_.bodies().size(); ++b) sum += colored(at.surface, sent[b]);
    return sum;
}

void IndirectCache::add_bodies_in_lobe(const FrameContext& frame, const ShadingPoint& at, Vec3f mirror,
                                       Spectrum weight, Spectrum& radiance) const {
    bool meets = false;
    for (std::size_t b = 0; b < planetshine_.bodies().size(); ++b) {
        meets = meets || planetshine_.is_met(b, mirror);
        radiance +=
            at.throughput * colored(at.surface, sent_of_body(b, at, at.normal, max_component(weight)));
    }
    // Small bodies and air.
    if (!meets && frame.background->may_meet_body(mirror))
        frame.background->add_bodies(at.start(), to_double(mirror), weight, radiance);
}

}  // namespace hilcam
