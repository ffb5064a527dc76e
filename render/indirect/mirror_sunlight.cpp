#include "render/indirect/mirror_sunlight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "render/radiosity/irradiance_cache.h"
#include "render/shading/normal_clusters.h"
#include "render/shading/shadow_rays.h"
#include "render/sunlight/radiance_equation.h"

namespace hilcam {
namespace {

// Half of the light of the Sun's disk comes from within this angle of its middle [rad]: 4.65 mrad over the
// root of two.
constexpr float kHalfSun_rad = 0.0033f;
// A mirror reflects next to nothing at flatter angles.
constexpr float kMinCosine = 0.01f;
// The share of GGX's slopes within r alpha is r^2 / (1 + r^2) (its density, Walter et al., EGSR 2007, eq. 33,
// integrated). Uniform distributions over disks of r = 1/2, 1, 2, 4 and 8 with these shares approximate it.
// Squares replace the disks: with half sides of 0.76 r [alpha] they also have the share within a strip, to
// 0.024.
struct Rectangle {
    float half, share;
};
constexpr std::array<Rectangle, 5> kRectangles{
    {{0.38f, 0.1f}, {0.76f, 0.3f}, {1.52f, 0.353f}, {3.04f, 0.1735f}, {6.08f, 0.0735f}}};

// A shading point with its ray to a mirror.
struct MirrorRay {
    const ShadingPoint* at;
    Spectrum light;    // sent towards the viewer if it sees the whole mirrored Sun
    Vec3f start_m;     // start of the ray
    Vec3f dir, sun;    // towards the mirrored Sun, and from the mirror to the Sun
    float cosine;      // cosine between the ray and the plane's normal
    float distance_m;  // to the plane
    float filled;      // share of its lobe that the mirror fills
    float even;        // 1: that share counts; 0: the result of the ray counts
};
struct Reflected {
    const ShadingPoint* at;
    Spectrum light;
};

// The light from a direction that a shading point reflects to the viewer, per unit of irradiance across that
// direction, and the start of a ray to test it.
struct Scattered {
    Spectrum light;
    Vec3f start_m;
    bool none = true;
};
Scattered scatter(const FrameContext& frame, const ShadingPoint& at, Vec3f dir, float alpha) {
    Bsdf surface = at.surface;
    const bool facets = surface.material->has_facets();
    // Slopes of independent causes add in quadrature; rays follow narrow lobes to the mirror.
    if (facets)
        surface.alpha =
            surface.alpha < kMinCachedAlpha ? 0 : std::min(1.0f, std::hypot(surface.alpha, alpha));
    if (at.clusters && !(facets && surface.alpha == 0)) {
        const SunlitPoint sunny{&at, dir,
                                facets ? std::min(1.0f, std::hypot(at.cluster_alpha, alpha)) : 0.0f};
        ClusterLight sum;
        lit_clusters(frame, {&sunny, 1}, {&sum, 1});
        if (sum.none()) return {};
        return {sum.reflected, sum.brightest[0]->start_m, false};
    }
    const float ni = dot(at.normal, dir);
    if (ni <= 0 || dot(at.geometric_normal, dir) <= 0) return {};
    const Cosines c{std::max(dot(at.normal, at.view_dir), 1e-4f), ni, dot(at.view_dir, dir)};
    const Spectrum light = ni * (at.throughput * brdf_value(surface, c));
    return {light, at.start(), !(max_component(light) > 0)};
}

// Tests one mirror for sixteen shading points at a time.
template <class Lit>
class Asker {
  public:
    Asker(Tile& tile, const MirrorSunlight::Shown& shown, Lit lit)
        : tile_(tile),
          frame_(tile.frame),
          shown_(shown),
          shape_(*shown.mirror.shape),
          object_(shown.mirror.number),
          sun_(tile),
          sunlight_(tile.frame, tile.stats.bounce_shadow_rays, std::move(lit)) {
        rays_.count = 0;
    }
    ~Asker() { flush(); }
    Asker(const Asker&) = delete;
    Asker& operator=(const Asker&) = delete;

    void ask(const ShadingPoint& at) {
        // Most points in front of a mirror face away from it; normals of clusters may differ by half a right
        // angle.
        if (dot(at.normal, shown_.dir) <= (at.clusters ? -0.7f : -0.01f)) return;
        const float above_m = dot(at.point_m - shown_.corner_m, shown_.normal);
        if (!(above_m > shown_.tolerance_m) || !at.surface.has_lobes()) return;
        MirrorRay asked;
        asked.at = &at;
        auto [sun, light] = sun_.of(at);
        // A widened disk includes the Sun's own.
        if (shown_.blur.x > 0)
            sun = to_float(frame_.background->sun_world_dir()),
            light = frame_.background->sun_irradiance_w_m2_um();
        asked.sun = sun;
        asked.cosine = dot(sun, shown_.normal);
        if (asked.cosine < kMinCosine) return;
        asked.dir = sun - 2 * asked.cosine * shown_.normal;
        asked.distance_m = above_m / asked.cosine;
        const Vec3f from = at.point_m + asked.distance_m * asked.dir - shown_.corner_m;
        if (!look_up({dot(from, shown_.across), dot(from, shown_.down)}, asked)) return;
        const Scattered out = scatter(frame_, at, asked.dir, shown_.mirror.alpha);
        if (out.none) return;
        asked.light = out.light * shown_.reflectance * light;
        asked.start_m = out.start_m;
        const auto k = static_cast<std::size_t>(rays_.count);
        asked_[k] = asked;
        rays_.set(rays_.count, asked.start_m, asked.dir, 0,
                  asked.distance_m + 2 * shown_.tolerance_m / asked.cosine);
        if (++rays_.count == kPacketSize) flush();
    }

  private:
    Tile& tile_;
    const FrameContext& frame_;
    const MirrorSunlight::Shown& shown_;
    const FlatMirror& shape_;
    std::uint32_t object_;
    SunSampler sun_;
    ShadowRays<Reflected, Lit> sunlight_;
    RayPacket rays_;
    HitPacket hits_;
    std::array<MirrorRay, kPacketSize> asked_;

    // Finds the share of the lobe that the mirror fills, around a place in its plane. Returns false if it is
    // zero.
    bool look_up(Vec2f place, MirrorRay& asked) const {
        const Vec2f cell = shape_.cell_m();
        // The map is as fine as its cells and as exact as the level of detail. Sharper light gets its edges
        // from rays.
        const Vec2f coarse{2 * (cell.x + shown_.tolerance_m), 2 * (cell.y + shown_.tolerance_m)};
        const Vec2f blur{shown_.blur.x * asked.distance_m, shown_.blur.y * asked.distance_m};
        asked.even = std::clamp(std::min(blur.x / coarse.x, blur.y / coarse.y) - 1, 0.0f, 1.0f);
        asked.filled = 0;
        float most = 0;
        Vec2f brightest = place;
        // The largest first: most points see nothing of it.
        for (auto part = kRectangles.rbegin(); part != kRectangles.rend(); ++part) {
            const Vec2f size{std::max(2 * part->half * blur.x, coarse.x),
                             std::max(2 * part->half * blur.y, coarse.y)};
            const float filled = part->share * shape_.filled(place, size);
            asked.filled += filled;
            if (asked.filled == 0) return false;
            if (filled > most) most = filled, brightest = shape_.middle_within(place, size);
        }
        const float least = frame_.contribution_threshold;
        if (least > 0)
            asked.filled *=
                std::clamp(asked.filled * max_component(shown_.reflectance) / least - 1, 0.0f, 1.0f);
        if (!(asked.filled > 0)) return false;
        if (asked.even > 0) aim_at_mirror(place, brightest, asked);
        return true;
    }

    // Light from a rough mirror comes from where the mirror is, even if that is only a ring. One place
    // decides whether it is visible and lit: a filled one in the middle of the rectangle that contributes
    // most.
    void aim_at_mirror(Vec2f place, Vec2f brightest, MirrorRay& asked) const {
        const Vec2f from = shape_.nearest_filled(brightest);
        const Vec2f off{from.x - place.x, from.y - place.y};
        const Vec3f way =
            asked.distance_m * asked.dir + asked.even * (off.x * shown_.across + off.y * shown_.down);
        asked.cosine = -dot(way, shown_.normal);
        asked.distance_m = length(way);
        asked.cosine /= asked.distance_m;
        asked.dir = way / asked.distance_m;
    }

    void flush() {
        if (rays_.count == 0) return;
        frame_.scene->intersect(rays_, Coherence::kCoherent, hits_);
        tile_.stats.secondary_rays += static_cast<std::uint64_t>(rays_.count);
        for (int i = 0; i < rays_.count; ++i) answer(asked_[static_cast<std::size_t>(i)], i);
        rays_.count = 0;
    }

    void answer(MirrorRay& asked, int lane) {
        const auto k = static_cast<std::size_t>(lane);
        const bool hit = hits_.object[k] != HitPacket::kMiss;
        bool met = false;
        Vec3f from = asked.start_m + asked.distance_m * asked.dir + shown_.tolerance_m * shown_.normal;
        if (hit && (asked.distance_m - hits_.distance[k]) * asked.cosine > shown_.tolerance_m) {
            if (!frame_.has_glass) return;
            // Behind glass the mirror's map decides what is met.
            const float until_m = asked.distance_m - shown_.tolerance_m / asked.cosine;
            asked.light = passed_through_glass(frame_, asked.start_m, asked.dir, until_m) * asked.light;
            met = asked.filled > 0.5f;
        } else if (hit && hits_.object[k] == object_) {
            const ObjectSurfaces& surfaces = *(*frame_.objects)[object_];
            met = surfaces.triangles[hits_.triangle[k]].surface == shape_.surface;
            if (met)
                from = asked.start_m + hits_.distance[k] * asked.dir + asked.at->offset_m * shown_.normal;
        }
        const float share = met ? asked.even * asked.filled + 1 - asked.even : 0.0f;
        const Spectrum light = share * asked.light;
        if (max_component(light) > 0) sunlight_.add(from, asked.sun, {asked.at, light});
    }
};

}  // namespace

void MirrorSunlight::add(const ShownObject& object, std::size_t number, std::span<const FlatMirror> mirrors,
                         std::span<const MaterialAlbedo> albedos) {
    for (const FlatMirror& mirror : mirrors)
        mirrors_.push_back({&object, static_cast<std::uint32_t>(number), &mirror, &albedos[mirror.surface],
                            object.materials()[mirror.surface].ggx_alpha});
    shown_.reserve(mirrors_.size()), beams_.reserve(mirrors_.size());
}

namespace {

// A facet that leans along the plane of incidence turns light by twice that angle; one that leans across it,
// by a factor of the cosine less. On the mirror's plane the former is longer by one over the cosine. At flat
// angles, where facets hide each other, it is limited to that at six degrees.
Vec2f blur_of(const MirrorSunlight::Shown& shown, Vec3f sun) {
    const float cosine = std::max(dot(sun, shown.normal), 0.1f), turned = 2 * shown.mirror.alpha;
    const float along = std::hypot(turned, kHalfSun_rad) / cosine,
                beside = std::hypot(turned * cosine, kHalfSun_rad);
    const Vec3f flat = sun - dot(sun, shown.normal) * shown.normal;
    const float sine = length(flat);
    const Vec3f incidence = sine > 1e-3f ? flat / sine : shown.across;
    const auto size = [&](Vec3f axis) {
        const float in = dot(incidence, axis), out = std::sqrt(std::max(0.0f, 1 - in * in));
        return std::hypot(in * along, out * beside);
    };
    return {size(shown.across), size(shown.down)};
}

// least: the smallest share of the Sun that counts.
void find_beam(Vec3f sun, float least, MirrorSunlight::Shown& out) {
    using Line = ReflectedBeam::Line;
    const float cosine = dot(sun, out.normal);
    const Vec3f dir = out.dir = sun - 2 * cosine * out.normal;
    ReflectedBeam& beam = out.beam;
    beam.min_m = out.tolerance_m;
    beam.width_m = out.mirror.shape->width_m, beam.height_m = out.mirror.shape->height_m;
    const auto line = [&](Vec3f by_place) { return Line{by_place, -dot(by_place, out.corner_m)}; };
    const Vec3f per_m = (1 / cosine) * out.normal;
    beam.distance = line(per_m);
    beam.x = line(out.across + dot(dir, out.across) * per_m);
    beam.y = line(out.down + dot(dir, out.down) * per_m);
    // The extent of the widest rectangle that counts, or the edge of the Sun's disk.
    const float disk = 2 * kHalfSun_rad / cosine;
    float widest = 0, share = 0;
    for (auto part = kRectangles.rbegin(); part != kRectangles.rend() && widest == 0; ++part) {
        share += part->share;
        if (share * max_component(out.reflectance) > least) widest = part->half;
    }
    beam.margin = {std::max(widest * out.blur.x, disk), std::max(widest * out.blur.y, disk)};
    const Vec2f cell = out.mirror.shape->cell_m();
    beam.margin_m = {2 * (cell.x + out.tolerance_m), 2 * (cell.y + out.tolerance_m)};
}

}  // namespace

void MirrorSunlight::place(const FrameContext& frame, const WorldSnapshot& world) {
    shown_.clear(), beams_.clear();
    if (!(max_component(frame.background->sun_irradiance_w_m2_um()) > 0)) return;
    const Vec3f sun = to_float(frame.background->sun_world_dir());
    for (const Mirror& mirror : mirrors_) {
        const FlatMirror& shape = *mirror.shape;
        const Mat3f& axes = frame.world_from_body[mirror.number];
        Vec3f normal = axes * shape.normal;
        if (dot(normal, sun) < 0) normal = -normal;
        const float cosine = dot(normal, sun);
        const Spectrum reflectance = mirror.albedo->lobe(cosine);
        if (cosine < kMinCosine || max_component(reflectance) < frame.contribution_threshold) continue;
        const Vec3f origin_m = to_float(world.objects[mirror.number].position_world_m - frame.rays_world_m);
        Shown out{mirror,
                  normal,
                  origin_m + axes * shape.corner_m,
                  axes * shape.across,
                  axes * shape.down,
                  reflectance,
                  shape.tolerance_m,
                  {}};
        for (std::size_t l = 0; l < mirror.object->levels.size(); ++l)
            if (mirror.object->levels[l].get() == (*frame.objects)[mirror.number])
                out.tolerance_m += static_cast<float>(mirror.object->error_m[l]);
        // Rounding: a place in ray space is good to some 1e-7 of its distance.
        out.tolerance_m += 32 * std::numeric_limits<float>::epsilon() * length(out.corner_m);
        if (2 * mirror.alpha > kHalfSun_rad) out.blur = blur_of(out, sun);
        find_beam(sun, frame.contribution_threshold, out);
        shown_.push_back(out);
        beams_.add(out.beam);
    }
}

namespace {

PlaceBox box_of(std::span<const ShadingPoint> points) {
    Vec3f least = points.front().point_m, most = least;
    for (const ShadingPoint& at : points) {
        least = {std::min(least.x, at.point_m.x), std::min(least.y, at.point_m.y),
                 std::min(least.z, at.point_m.z)};
        most = {std::max(most.x, at.point_m.x), std::max(most.y, at.point_m.y),
                std::max(most.z, at.point_m.z)};
    }
    return {0.5f * (least + most), 0.5f * (most - least)};
}

}  // namespace

void MirrorSunlight::add_light(Tile& tile, std::span<const ShadingPoint> points) const {
    BeamPlaces places;
    for (std::size_t first = 0; first < points.size() && !shown_.empty(); first += BeamPlaces::kMax) {
        const std::span<const ShadingPoint> some =
            points.subspan(first, std::min(BeamPlaces::kMax, points.size() - first));
        for (std::size_t i = 0; i < BeamPlaces::kMax; ++i) {
            const Vec3f point_m = some[std::min(i, some.size() - 1)].point_m;
            places.x[i] = point_m.x, places.y[i] = point_m.y, places.z[i] = point_m.z;
        }
        const PlaceBox box = box_of(some);
        std::array<std::uint8_t, ReflectedBeams::kTogether> meets;
        for (std::size_t block = 0; block < beams_.blocks(); ++block) {
            beams_.find(box, block, meets);
            for (auto met = meets.begin(); (met = std::find(met, meets.end(), 1)) != meets.end(); ++met) {
                const auto in_block = static_cast<std::size_t>(met - meets.begin());
                add_light_of(shown_[block * ReflectedBeams::kTogether + in_block], tile, some, places);
            }
        }
    }
}

// points: at most as many as places, and at those places.
void MirrorSunlight::add_light_of(const Shown& shown, Tile& tile, std::span<const ShadingPoint> points,
                                  BeamPlaces& places) const {
    find_places_in_beam(shown.beam, places);
    const auto* const all = places.in_beam.data();
    const auto* const end = all + points.size();
    const auto* seen = std::find(all, end, 1);
    if (seen == end) return;
    const auto lit = [&](const Reflected& by, const Spectrum* glass) {
        tile.add(*by.at, LightPart::kMirroredSun, glass ? by.light * *glass : by.light);
    };
    Asker<decltype(lit)> asker(tile, shown, lit);
    for (; seen != end; seen = std::find(seen + 1, end, 1))
        asker.ask(points[static_cast<std::size_t>(seen - all)]);
}

}  // namespace hilcam
