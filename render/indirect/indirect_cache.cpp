#include "render/indirect/indirect_cache.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "render/shading/lamp_light.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Returns the grid step for an object that rotates: light is solved at most twice a second, with steps up to
// 10 degrees, which cost 0.7 of the sensor's noise (docs/performance.md).
float step_of(const ShownObject& object, float min_rad) {
    constexpr float kSolve_s = 0.5f, kMax_rad = 0.175f;
    return std::max(min_rad, std::min(kMax_rad, kSolve_s * static_cast<float>(object.turn_rate_rad_s)));
}

// Returns the smallest alpha of all materials; 1: there are no facets.
float narrowest_alpha(std::span<const ShownObject> objects) {
    float least = 1;
    for (const ShownObject& object : objects)
        for (const Material& material : object.materials())
            if (material.has_facets()) least = std::min(least, material.ggx_alpha);
    return least;
}

}  // namespace

IndirectCache::IndirectCache(std::span<const ShownObject> objects, const EmbreeScene& scene,
                             const ColorBands& bands, const Settings& settings)
    : terms_{settings.lamps, settings.emission},
      objects_(objects.size()),
      planetshine_(narrowest_alpha(objects)) {
    std::vector<IrradianceCache*> lights(objects.size());
    std::map<const ObjectSurfaces*, std::shared_ptr<const ObjectAlbedos>> albedos;  // by prototype
    for (std::size_t i = 0; i < objects.size(); ++i) {
        if (!objects[i].transfer || objects[i].transfer->size() == 0) continue;
        std::shared_ptr<const ObjectAlbedos>& of_make = albedos[objects[i].levels.front().get()];
        if (!of_make)
            of_make = std::make_shared<const ObjectAlbedos>(*objects[i].levels.front(), scene.mesh(i, 0),
                                                            objects[i].transfer->probes(),
                                                            IrradianceCache::min_alpha(*objects[i].transfer));
        objects_[i].light = std::make_unique<IrradianceCache>(objects[i], of_make, bands,
                                                              step_of(objects[i], settings.step_rad));
        lights[i] = objects_[i].light.get();
        mirror_sunlight_.add(objects[i], i, lights[i]->mirrors(), lights[i]->albedos());
        for (std::size_t term = 0; term < terms_.count(); ++term) lights[i]->add_term(terms_.kind(term));
    }
    lights_.assign(lights.begin(), lights.end());
    updates_ = std::make_unique<SolveAhead>(lights, scene, terms_);
    for (SolveKey* key : {&key_, &ahead_key_}) key->reserve(objects.size(), terms_);
    for (SolveInputs* inputs : {&now_, &before_, &long_before_, &ahead_})
        inputs->objects.resize(objects.size()), inputs->lamps.reserve(settings.lamps);
}

std::string IndirectCache::describe(std::size_t i) const {
    const IrradianceCache& light = *objects_[i].light;
    const TransferTable& table = light.table();
    std::ostringstream text;
    text << table.size() << " places, " << 1e3f * table.probes().cube_m() << " mm apart, "
         << table.directions() << " directions each, of which " << table.entries()
         << " meet something; steps of " << light.step_rad() / static_cast<float>(kDegree_rad) << " deg; "
         << light.mirrors().size() << " flat mirrors throw sunlight; table "
         << static_cast<double>(table.bytes()) * 1e-6 << " MB, light "
         << static_cast<double>(light.bytes() + updates_->bytes(i)) * 1e-6 << " MB";
    return text.str();
}

void IndirectCache::take_inputs(const FrameContext& frame, const WorldSnapshot& world) {
    std::copy(world.objects.begin(), world.objects.end(), now_.objects.begin());
    now_.sun = max_component(frame.background->sun_irradiance_w_m2_um()) > 0;
    if (now_.sun) now_.sun_dir = to_float(frame.background->sun_world_dir());
    now_.body_count = planetshine_.bodies().size();
    for (std::size_t b = 0; b < now_.body_count; ++b)
        now_.bodies[b] = {planetshine_.bodies()[b].light_dir, planetshine_.bodies()[b].light_cosine};
    now_.lamps.clear();
    if (frame.lamps)
        for (const PlacedLamp& lamp : frame.lamps->lit())
            now_.lamps.push_back(
                {lamp.number, lamp.position_m + frame.rays_world_m, to_float(lamp.axis), lamp.beam});
}

void IndirectCache::set_key(const FrameContext& frame, const WorldSnapshot& world) {
    // One place represents a square of four pixels, 2.8 across, whose mirrors lean by 2 mrad against each
    // other.
    constexpr float kSquare_px = 3, kLean_rad = 0.002f;
    planetshine_.place(*frame.background,
                       kSquare_px / static_cast<float>(frame.geometry.focal_length_px) + 2 * kLean_rad);
    take_inputs(frame, world);
    key_.set(now_, lights_, terms_);
}

void IndirectCache::place(const FrameContext& frame, const WorldSnapshot& world) {
    for (std::size_t i = 0; i < objects_.size(); ++i)
        objects_[i].origin_m = to_float(world.objects[i].position_world_m - frame.rays_world_m);
    mirror_sunlight_.place(frame, world);
    set_key(frame, world);
    updates_->bring_to(key_);
    look_ahead();
}

bool IndirectCache::prepare(const FrameContext& frame, const WorldSnapshot& world) {
    if (!is_asked_) {
        set_key(frame, world);
        updates_->look_ahead(key_);
        is_asked_ = true;
    }
    return !updates_->is_busy();
}

// Asks for the key that the next frames will need first if everything continues its motion.
void IndirectCache::look_ahead() {
    if (frames_++ % kStride == 0) std::swap(long_before_, before_), before_ = now_;
    const auto past = static_cast<double>(kStride + (frames_ - 1) % kStride);  // frames since long_before_
    if (frames_ <= 2 * kStride || updates_->is_busy()) return;
    const auto differs = [&](int ahead) {
        if (!SolveInputs::extrapolate(long_before_, now_, ahead / past, ahead_)) return false;
        ahead_key_.set(ahead_, lights_, terms_);
        return !(ahead_key_ == key_);
    };
    // Usually nothing changes by a step for a long time; the first change is searched only if there is one.
    constexpr int kFurthest = 128;
    if (!differs(kFurthest)) return;
    for (int ahead = 1; ahead <= kFurthest; ahead *= 2)
        if (differs(ahead)) return updates_->look_ahead(ahead_key_);
}

}  // namespace hilcam
