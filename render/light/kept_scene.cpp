#include "render/light/kept_scene.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "render/light/lamp_light.h"
#include "render/scene/brdf_microfacet.h"

namespace hilcam {
namespace {

Vec3f to_body(const Mat3f& world_from_body, Vec3f world) { return transposed(world_from_body) * world; }

// What a texture makes of a material's own spectrum there.
Spectrum tint(const Scatterer& at) {
    Spectrum out;
    const bool shiny =
        at.material->model == ReflectionModel::kMetal || at.material->model == ReflectionModel::kMirror;
    const Spectrum& own = shiny ? at.material->highlight : at.material->base;
    const Spectrum& here = shiny ? at.highlight : at.base;
    for (int b = 0; b < kMaxBins; ++b) out[b] = own[b] > 0 ? here[b] / own[b] : 1.0f;
    return out;
}

}  // namespace

KeptScene::KeptScene(std::span<const ShownObject> objects, const ColorBands& bands, const Settings& settings)
    : objects_(objects.size()) {
    using Kind = KeptSource::Kind;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        if (!objects[i].transfer || objects[i].transfer->size() == 0) continue;
        Object& object = objects_[i];
        object.light = std::make_unique<KeptLight>(objects[i].transfer, objects[i].materials(), bands,
                                                   settings.step_rad);
        object.sun = object.light->make_term(Kind::kSun);
        for (KeptTerm& term : object.bodies) term = object.light->make_term(Kind::kCone);
        for (std::size_t lamp = 0; lamp < settings.lamps; ++lamp)
            object.lamps.push_back(object.light->make_term(Kind::kLamp));
        if (settings.emission) object.glow = object.light->make_term(Kind::kGlow);
        work_.reserve(*object.light);
    }
}

std::string KeptScene::describe(std::size_t i) const {
    const Object& object = objects_[i];
    const TransferTable& table = object.light->table();
    std::size_t bytes = object.light->bytes();
    const auto add = [&bytes](const KeptTerm& term) {
        bytes += (term.irradiance.size() + term.along.size()) * sizeof(PackedSpectrum) + term.seen.size();
    };
    add(object.sun), add(object.glow);
    for (const KeptTerm& term : object.bodies) add(term);
    for (const KeptTerm& term : object.lamps) add(term);
    std::ostringstream text;
    text << table.size() << " places, " << 1e3f * table.nodes().cube_m() << " mm apart, "
         << table.directions() << " directions each, of which " << table.entries()
         << " meet something; table " << static_cast<double>(table.bytes()) * 1e-6 << " MB, light "
         << static_cast<double>(bytes) * 1e-6 << " MB";
    return text.str();
}

void KeptScene::solve(const FrameView& frame, std::size_t i, const KeptSource& source, KeptTerm& term) {
    const KeptSource rounded = source.rounded(objects_[i].light->step_rad());
    if (rounded == term.source) return;
    objects_[i].light->solve(rounded, *frame.scene, i, work_, term);
}

void KeptScene::place(const FrameView& frame, const WorldSnapshot& world) {
    using Kind = KeptSource::Kind;
    sky_.place(*frame.background);
    for (std::size_t i = 0; i < objects_.size(); ++i) {
        Object& object = objects_[i];
        if (!object.light) continue;
        object.origin_m = to_float(world.objects[i].position_world_m - frame.rays_world_m);
        const Mat3f& axes = frame.world_from_body[i];
        if (largest(frame.background->sun_irradiance_w_m2_um()) > 0)
            solve(frame, i,
                  {.kind = Kind::kSun, .dir = to_body(axes, to_float(frame.background->sun_world_dir()))},
                  object.sun);
        for (std::size_t b = 0; b < sky_.bodies().size(); ++b) {
            const SkyLight::Body& body = sky_.bodies()[b];
            solve(
                frame, i,
                {.kind = Kind::kCone, .dir = to_body(axes, body.light_dir), .cone_cosine = body.light_cosine},
                object.bodies[b]);
        }
        if (frame.lamps)
            for (const PlacedLamp& lamp : frame.lamps->lit())
                solve(frame, i,
                      {.kind = Kind::kLamp,
                       .dir = to_body(axes, to_float(lamp.axis)),
                       .position_m = to_body(axes, to_float(lamp.position_m) - object.origin_m),
                       .beam = lamp.beam},
                      object.lamps[lamp.number]);
        if (!object.glow.irradiance.empty()) solve(frame, i, {.kind = Kind::kGlow}, object.glow);
    }
}

NodesAbout KeptScene::nodes_about(const FrameView& frame, const Vertex& at, bool& found,
                                  LightNodes::Hint& hint) const {
    const Mat3f& axes = frame.world_from_body[at.object];
    const Object& object = objects_[at.object];
    NodesAbout about;
    found = object.light->table().nodes().find(
        to_body(axes, at.point_m - object.origin_m),
        {to_body(axes, at.geometric_normal), at.surface_number, at.back}, about, hint);
    return about;
}

bool KeptScene::is_near(const FrameView& frame, const Vertex& at, Vec3f dir) const {
    if (objects_.size() > 1) return true;
    bool found = false;
    LightNodes::Hint hint;
    const NodesAbout about = nodes_about(frame, at, found, hint);
    if (!found || about.count == 0) return true;
    return objects_[at.object].light->is_near(about.nearest(),
                                              to_body(frame.world_from_body[at.object], dir));
}

void KeptScene::add_reflected(Tile& tile, std::span<const Vertex> vertices) const {
    LightNodes::Hint hint;
    for (const Vertex& at : vertices)
        if (!at.surface.is_glass()) tile.pixels[at.pixel] += at.weight * reflected(tile.frame, at, hint);
}

Spectrum KeptScene::reflected(const FrameView& frame, const Vertex& at, LightNodes::Hint& hint) const {
    const Object& object = objects_[at.object];
    const KeptLight& light = *object.light;
    bool found = false;
    const NodesAbout about = nodes_about(frame, at, found, hint);
    // Found, but no light gets there.
    if (found && about.count == 0) return {};

    const Spectrum& sun = frame.background->sun_irradiance_w_m2_um();
    const bool sunlit = largest(sun) > 0;
    // Irradiance: of all but the Sun by way of other surfaces, of the bodies without a way.
    Spectrum others, sky;
    for (std::size_t b = 0; b < sky_.bodies().size(); ++b) {
        const KeptTerm& term = object.bodies[b];
        others += sky_.bodies()[b].irradiance_w_m2_um * KeptLight::irradiance(term, about);
        sky += (found ? KeptLight::seen(term, about) : 1.0f) * sky_.irradiance(b, at.normal);
    }
    if (frame.lamps)
        for (const PlacedLamp& lamp : frame.lamps->lit())
            others += lamp.intensity_w_sr_um * KeptLight::irradiance(object.lamps[lamp.number], about);
    if (!object.glow.irradiance.empty()) others += KeptLight::irradiance(object.glow, about);
    Spectrum all = others + sky;
    if (sunlit) all += sun * KeptLight::irradiance(object.sun, about);

    const float no = std::max(dot(at.normal, at.view_dir), 1e-4f);
    const MaterialAlbedo& albedo = light.albedo(at.surface_number);
    const bool textured = at.surface.material->texture >= 0;
    Spectrum out = (1 / kPiF) * (albedo.base(no) * all);
    if (!at.surface.material->has_facets()) return textured ? tint(at.surface) * out : out;
    const Spectrum reflectance = albedo.lobe(no);
    if (at.surface.alpha >= kNarrowestLobe) {
        const Mat3f& axes = frame.world_from_body[at.object];
        KeptLight::Lobe lobe;
        if (found)
            lobe = light.lobe(sunlit ? &object.sun : nullptr, about.nearest(), to_body(axes, at.normal),
                              to_body(axes, at.view_dir), at.surface.alpha);
        Spectrum radiance = (lobe.occupied / kPiF) * others;
        if (sunlit) radiance += sun * lobe.kept;
        for (std::size_t b = 0; b < sky_.bodies().size(); ++b)
            radiance +=
                lobe.free * sky_.glossy(b, at.normal, at.view_dir, at.surface.alpha, largest(reflectance));
        out += reflectance * radiance;
    }
    return textured ? tint(at.surface) * out : out;
}

}  // namespace hilcam
