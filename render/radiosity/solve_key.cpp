#include "render/radiosity/solve_key.h"

#include <algorithm>
#include <cmath>

namespace hilcam {
namespace {

Vec3d extrapolated(Vec3d then, Vec3d now, double by) { return now + by * (now - then); }
Vec3f extrapolated(Vec3f then, Vec3f now, double by) {
    return normalized(now + static_cast<float>(by) * (now - then));
}
Quat extrapolated(Quat then, Quat now, double by) {
    const double cosine = then.w * now.w + then.x * now.x + then.y * now.y + then.z * now.z;
    const double sign = cosine < 0 ? -1 : 1;
    const auto part = [&](double a, double b) { return b + by * (b - sign * a); };
    return normalized(
        Quat{part(then.w, now.w), part(then.x, now.x), part(then.y, now.y), part(then.z, now.z)});
}

// With more objects than this, each keeps its light to itself: there would be too many pairs.
constexpr std::size_t kMaxLinked = 64;
// An object that covers less than this share of the sky, where it is nearest, is ignored.
constexpr float kMinShare = 0.004f;

// True when the other object matters for this one; both are in the other's axes.
bool is_near(const IrradianceCache& self, const IrradianceCache& other, const NeighbourObject& there) {
    const float gap_m =
        length(there.place(self.bounds().middle_m) - other.bounds().middle_m) - self.bounds().radius_m;
    const float radius_m = other.bounds().radius_m;
    return gap_m <= radius_m || radius_m * radius_m > kMinShare * gap_m * gap_m;
}

}  // namespace

RadiositySource::Kind RadiosityTerms::kind(std::size_t term) const {
    if (term == kSun) return RadiositySource::Kind::kSun;
    if (term < kLamps) return RadiositySource::Kind::kCone;
    return term < glow() ? RadiositySource::Kind::kLamp : RadiositySource::Kind::kGlow;
}

bool SolveInputs::extrapolate(const SolveInputs& then, const SolveInputs& now, double by, SolveInputs& out) {
    if (then.objects.size() != now.objects.size() || then.sun != now.sun ||
        then.body_count != now.body_count || then.lamps.size() != now.lamps.size())
        return false;
    out = now;
    for (std::size_t i = 0; i < now.objects.size(); ++i)
        out.objects[i] = {extrapolated(then.objects[i].position_world_m, now.objects[i].position_world_m, by),
                          extrapolated(then.objects[i].world_from_body, now.objects[i].world_from_body, by)};
    if (now.sun) out.sun_dir = extrapolated(then.sun_dir, now.sun_dir, by);
    for (std::size_t b = 0; b < now.body_count; ++b) {
        SolveInputs::Body& body = out.bodies[b];
        body.dir = extrapolated(then.bodies[b].dir, now.bodies[b].dir, by);
        body.cosine = std::clamp(
            now.bodies[b].cosine + static_cast<float>(by) * (now.bodies[b].cosine - then.bodies[b].cosine),
            -1.0f, 1.0f);
    }
    for (std::size_t l = 0; l < now.lamps.size(); ++l) {
        if (then.lamps[l].number != now.lamps[l].number) return false;
        out.lamps[l].position_world_m =
            extrapolated(then.lamps[l].position_world_m, now.lamps[l].position_world_m, by);
        out.lamps[l].axis = extrapolated(then.lamps[l].axis, now.lamps[l].axis, by);
    }
    return true;
}

void SolveKey::reserve(std::size_t objects, const RadiosityTerms& terms) {
    near.resize(objects), group.resize(objects);
    sources.assign(objects, std::vector<RadiositySource>(terms.count()));
    for (std::vector<NeighbourObject>& others : near)
        if (objects <= kMaxLinked) others.reserve(objects);
}

void SolveKey::set(const SolveInputs& inputs, std::span<const IrradianceCache* const> lights,
                   const RadiosityTerms& terms) {
    using Kind = RadiositySource::Kind;
    const std::size_t count = lights.size();
    near.resize(count), sources.resize(count), group.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        near[i].clear();
        sources[i].assign(terms.count(), {});
        group[i] = static_cast<std::uint32_t>(i);
    }
    for (std::size_t i = 0; i < count; ++i) {
        if (!lights[i]) continue;
        const float step_rad = lights[i]->step_rad();
        const Pose& pose = inputs.objects[i];
        const Mat3d axes = to_matrix(conjugate(pose.world_from_body));
        const Mat3f to_body{to_float(axes.x), to_float(axes.y), to_float(axes.z)};
        std::vector<RadiositySource>& out = sources[i];
        const auto add = [&](std::size_t term, const RadiositySource& source) {
            out[term] = source.rounded(step_rad);
        };
        if (inputs.sun) add(RadiosityTerms::kSun, {.kind = Kind::kSun, .dir = to_body * inputs.sun_dir});
        for (std::size_t b = 0; b < inputs.body_count; ++b)
            add(RadiosityTerms::kBodies + b, {.kind = Kind::kCone,
                                              .dir = to_body * inputs.bodies[b].dir,
                                              .cone_cosine = inputs.bodies[b].cosine});
        for (const SolveInputs::Lamp& lamp : inputs.lamps)
            add(RadiosityTerms::kLamps + lamp.number,
                {.kind = Kind::kLamp,
                 .dir = to_body * lamp.axis,
                 .position_m = to_float(axes * (lamp.position_world_m - pose.position_world_m)),
                 .beam = lamp.beam});
        if (terms.emission) add(terms.glow(), {.kind = Kind::kGlow});
        for (std::size_t k = 0; k < count && count <= kMaxLinked; ++k) {
            if (k == i || !lights[k]) continue;
            // A step of this rotation moves what is met as much as two steps of the Sun's direction move its
            // light.
            const NeighbourObject there = NeighbourObject::rounded(
                pose, inputs.objects[k], k, 2 * step_rad, 0.5f * lights[k]->table().probes().cube_m());
            if (!is_near(*lights[i], *lights[k], there)) continue;
            near[i].push_back(there);
            const std::uint32_t from = std::max(group[i], group[k]), to = std::min(group[i], group[k]);
            std::replace(group.begin(), group.end(), from, to);
        }
    }
}

}  // namespace hilcam
