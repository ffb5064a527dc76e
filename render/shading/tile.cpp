#include "render/shading/tile.h"

namespace hilcam {
namespace {

// Returns how many of sixteen samples of its pixel see a shading point. For one of several rays it is
// unknown, because the others may meet something else.
float samples_of(const Tile& tile, const ShadingPoint& at) {
    if (at.samples != 0) return at.weight_samples;
    return tile.samples_per_axis == 1 ? kVisibilitySamples : 0.0f;
}

PixelRecord::Entry entry_of(const Tile& tile, const ShadingPoint& at, LightPart part, const Spectrum& light) {
    PixelRecord::Entry entry;
    entry.part = part, entry.depth = at.depth, entry.light = light;
    entry.object = at.object, entry.triangle = at.triangle, entry.surface = at.surface_number;
    entry.back = at.back, entry.point_m = at.point_m, entry.geometric_normal = at.geometric_normal;
    entry.alpha = at.surface.alpha, entry.samples = samples_of(tile, at);
    return entry;
}

LightPart part_of(const ShadingPoint& at, LightPart part) { return at.depth > 1 ? at.ray_part : part; }

}  // namespace

void Tile::note(const ShadingPoint& at, LightPart of_source, const Spectrum& light) const {
    const LightPart part = part_of(at, of_source);
    if (!at.glossy_ray) {
        parts->add(at.pixel, part, light);
        if (parts->is_recorded(at.pixel)) parts->record->add(entry_of(*this, at, part, parts->share * light));
        return;
    }
    // Each pixel's share is known when all rays are finished.
    const GlossyPoint& of = glossy->point_of(*at.glossy_ray);
    if (!parts->is_recorded(of.pixel)) return;
    PixelRecord::Entry entry = entry_of(*this, at, part, (parts->share * of.per_light) * (of.weight * light));
    entry.is_shared = true;
    parts->record->add(entry);
}

void Tile::note(std::uint32_t pixel, LightPart part, const Spectrum& light) const {
    parts->add(pixel, part, light);
    if (!parts->is_recorded(pixel)) return;
    PixelRecord::Entry entry;
    entry.part = part, entry.light = parts->share * light;
    parts->record->add(entry);
}

void Tile::note_move(const ShadingPoint& at, LightPart from, LightPart to, const Spectrum& light) const {
    if (at.glossy_ray || at.depth > 1) return;  // light of a ray is all of the ray's part
    parts->move(at.pixel, from, to, light);
    if (!parts->is_recorded(at.pixel)) return;
    parts->record->add(entry_of(*this, at, from, -parts->share * light));
    parts->record->add(entry_of(*this, at, to, parts->share * light));
}

}  // namespace hilcam
