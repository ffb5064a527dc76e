#include "render/light/facet_list.h"

#include <algorithm>
#include <cmath>

namespace hilcam {
namespace {

constexpr float kSame = 0.999998f;  // cosine

}  // namespace

Facets& FacetList::open(Vertex& vertex) {
    Facets& added = facets_[count_++];
    added.samples = {};
    added.count = 0;
    added.next = vertex.facets;
    vertex.facets = &added;
    return added;
}

void FacetList::add_part(const Part& part, Vertex& vertex) {
    const bool room = vertex.facets && vertex.facets->count < Facets::kMost;
    Facets& to = room ? *vertex.facets : open(vertex);
    const std::size_t i = to.count++;
    to.geometric_normal.set(i, part.geometric_normal);
    to.normal.set(i, part.normal);
    to.start_m.set(i, part.start_m);
    to.samples[i] = part.samples;
}

// A level of detail is flat where the mesh is wrinkled: its facets lean as the wrinkles did, and are seen as
// they are. False: none of them is.
bool FacetList::add_flattened(const FrameView& frame, const Part& flat, const LevelFacets& leaning,
                              Vertex& vertex) {
    const Mat3f& world_from_body = frame.world_from_body[vertex.object];
    const float side = vertex.back ? -1.0f : 1.0f;
    const LevelFacets::Leans lean = leaning.leans();
    const LevelFacets::Floats share = leaning.shares();
    Facets::Vectors normal;
    Facets::Floats samples;
    for (std::size_t i = 0; i < Facets::kMost; ++i) {
        const auto along = [&](Vec3f row) {
            return side * (row.x * lean.x[i] + row.y * lean.y[i] + row.z * lean.z[i]);
        };
        const float x = flat.normal.x + along(world_from_body.x),
                    y = flat.normal.y + along(world_from_body.y),
                    z = flat.normal.z + along(world_from_body.z);
        const float inverse = 1 / std::sqrt(std::max(x * x + y * y + z * z, 1e-12f));
        normal.x[i] = inverse * x, normal.y[i] = inverse * y, normal.z[i] = inverse * z;
        const float no = normal.x[i] * vertex.view_dir.x + normal.y[i] * vertex.view_dir.y +
                         normal.z[i] * vertex.view_dir.z;
        samples[i] = share[i] * std::max(0.0f, no);
    }
    const float sum = (samples[0] + samples[1]) + (samples[2] + samples[3]);
    if (!(sum > 0)) return false;
    Facets& to = open(vertex);
    to.count = Facets::kMost;
    to.geometric_normal = to.normal = normal;
    to.start_m.x.fill(flat.start_m.x), to.start_m.y.fill(flat.start_m.y), to.start_m.z.fill(flat.start_m.z);
    const float each = flat.samples / sum;
    for (std::size_t i = 0; i < Facets::kMost; ++i) to.samples[i] = each * samples[i];
    return true;
}

void FacetList::add(const FrameView& frame, const Part& part, std::uint32_t triangle, bool first,
                    Vertex& vertex) {
    const ObjectSurfaces& object = *(*frame.objects)[vertex.object];
    const float flattened = object.facets.empty() ? 0.0f : object.flattened_alpha[vertex.surface_number];
    if (first && flattened > 0)
        vertex.facet_alpha =
            std::sqrt(std::max(0.0f, vertex.surface.alpha * vertex.surface.alpha - flattened * flattened));
    const bool leans = !object.facets.empty() && !object.facets[triangle].is_flat();
    if (!leans && flattened == 0 && !vertex.facets && (first || dot(vertex.normal, part.normal) > kSame))
        return;
    if (!first && !vertex.facets)
        add_part({vertex.geometric_normal, vertex.normal, vertex.start(), vertex.weight_samples}, vertex);
    if (!leans || !add_flattened(frame, part, object.facets[triangle], vertex)) add_part(part, vertex);
}

}  // namespace hilcam
