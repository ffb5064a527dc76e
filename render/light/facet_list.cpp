#include "render/light/facet_list.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/clones.h"

namespace hilcam {
namespace {

constexpr float kSame = 0.999998f;  // cosine

// Facets side by side, those that one flattened facet stands for next to each other.
struct Lanes {
    using Floats = BrdfSum::Lanes;
    // A normal, how the lane leans against it (body axes), and its share of the area.
    Floats x, y, z, lean_x, lean_y, lean_z, share;
    Floats rougher;                 // square of the alpha that its normals scatter by
    Floats no, ni;                  // cosines, above zero
    Floats seen, lit;               // the share as the viewer and the light see it
    Floats area_x, area_y, area_z;  // the share along its normal
    std::size_t count = 0;

    // Puts the next kPart lanes, all of one normal.
    template <std::size_t kPart>
    void put(Vec3f normal, const std::array<float, kPart>& leans_x, const std::array<float, kPart>& leans_y,
             const std::array<float, kPart>& leans_z, const std::array<float, kPart>& part, float alpha) {
        const std::size_t first = count;
        const auto write = [first](Floats& to, const std::array<float, kPart>& of) {
            std::copy_n(of.data(), kPart, to.data() + first);
        };
        const auto fill = [first](Floats& to, float of) { std::fill_n(to.data() + first, kPart, of); };
        fill(x, normal.x), fill(y, normal.y), fill(z, normal.z);
        write(lean_x, leans_x), write(lean_y, leans_y), write(lean_z, leans_z);
        fill(rougher, alpha * alpha), write(share, part);
        count = first + kPart;
    }
    // A facet that does not lean.
    void put(Vec3f normal, float part) { put<1>(normal, {0}, {0}, {0}, {part}, 0); }
};

// count: a multiple of BrdfSum::kEach.
HILCAM_CLONES void look_at(Lanes& lanes, std::size_t count, const Mat3f& world_from_body, Vec3f view,
                           Vec3f dir) {
    const Mat3f m = world_from_body;
    for (std::size_t i = 0; i < count; ++i) {
        const float lx = lanes.lean_x[i], ly = lanes.lean_y[i], lz = lanes.lean_z[i];
        const float x = lanes.x[i] + (m.x.x * lx + m.x.y * ly + m.x.z * lz);
        const float y = lanes.y[i] + (m.y.x * lx + m.y.y * ly + m.y.z * lz);
        const float z = lanes.z[i] + (m.z.x * lx + m.z.y * ly + m.z.z * lz);
        const float inverse = 1 / std::sqrt(std::max(x * x + y * y + z * z, 1e-12f));
        const float no = inverse * (x * view.x + y * view.y + z * view.z);
        const float area = lanes.share[i] * inverse;
        lanes.seen[i] = lanes.share[i] * std::max(no, 0.0f);
        lanes.no[i] = std::max(no, 1e-4f);
        lanes.ni[i] = std::max(inverse * (x * dir.x + y * dir.y + z * dir.z), 0.0f);
        lanes.lit[i] = lanes.share[i] * lanes.ni[i];
        lanes.area_x[i] = area * x, lanes.area_y[i] = area * y, lanes.area_z[i] = area * z;
    }
}

// The facets of a vertex on their way through the lanes.
class Reflection {
  public:
    Reflection(const FrameView& frame, const Vertex& at, const Scatterer& surface, Vec3f dir)
        : frame_(frame),
          world_from_body_(frame.world_from_body[at.object]),
          at_(at),
          dir_(dir),
          sum_(surface, dot(at.view_dir, dir)) {}

    FacetLight of_all() {
        for (const Facet* facet = at_.facets; facet; facet = facet->next) {
            if (lanes_.count + LevelFacets::kMax > lanes_.x.size()) reflect();
            put(*facet);
        }
        reflect();
        light_.reflected = (1 / samples_) * (at_.weight * sum_.value());
        light_.halves = all_ > 0 ? (1 / all_) * halves_ : at_.halves;
        return light_;
    }

  private:
    const FrameView& frame_;
    const Mat3f& world_from_body_;
    const Vertex& at_;
    Vec3f dir_;
    BrdfSum sum_;
    Lanes lanes_;
    struct Group {
        const Facet* facet;
        std::size_t first, count;
    };
    std::array<Group, BrdfSum::kLanes> groups_;
    std::size_t group_count_ = 0;
    float samples_ = 0, all_ = 0;
    HalfShares halves_;  // times the light
    FacetLight light_;

    void put(const Facet& facet) {
        samples_ += facet.samples;
        const std::size_t first = lanes_.count;
        if (facet.flattened) {
            LevelFacets::Leans lean = facet.flattened->leans();
            const float side = at_.back ? -1.0f : 1.0f;
            for (std::size_t i = 0; i < LevelFacets::kMax; ++i)
                lean.x[i] *= side, lean.y[i] *= side, lean.z[i] *= side;
            lanes_.put(facet.normal, lean.x, lean.y, lean.z, facet.flattened->shares(),
                       facet.flattened->alpha());
        } else {
            if (dot(facet.geometric_normal, dir_) <= 0) return;
            lanes_.put(facet.normal, 1);
        }
        groups_[group_count_++] = {&facet, first, lanes_.count - first};
    }

    static float sum_of(const Lanes::Floats& floats, const Group& group) {
        float sum = 0;
        for (std::size_t i = group.first; i < group.first + group.count; ++i) sum += floats[i];
        return sum;
    }

    // Wrinkles shade each other, most where the light comes along them: as much of it falls on all of them together
    // as on the flat triangle, whatever their sides face (the condition that Smith's shadowing is made of: Heitz,
    // JCGT 3(2), 2014, section 2). More than 1 where they lean away from the light; so much only, as the triangle
    // has an error of its own.
    float share_in_light(const Group& group) const {
        constexpr float kMost = 2;
        if (!group.facet->flattened) return 1;
        const float lit = sum_of(lanes_.lit, group);
        const float flat = dot(group.facet->geometric_normal, dir_);
        if (!(lit > 0 && flat > 0)) return 1;
        const Vec3f area{sum_of(lanes_.area_x, group), sum_of(lanes_.area_y, group),
                         sum_of(lanes_.area_z, group)};
        return std::min(flat * length(area) / lit, kMost);
    }

    void reflect() {
        if (lanes_.count == 0) return;
        const std::size_t count = lanes_.count;
        while (lanes_.count % BrdfSum::kEach != 0) lanes_.put(at_.normal, 0);
        look_at(lanes_, lanes_.count, world_from_body_, at_.view_dir, dir_);
        Lanes::Floats weight{};
        for (const Group& group : std::span(groups_).first(group_count_)) {
            const float seen = sum_of(lanes_.seen, group), in_light = share_in_light(group);
            // A facet that leans away from the viewer as a whole is seen as it lies itself.
            const bool hidden = !(seen > 0);
            const float each = in_light * group.facet->samples / (hidden ? 1 : seen);
            for (std::size_t i = group.first; i < group.first + group.count; ++i)
                weight[i] = each * (hidden ? lanes_.share[i] : lanes_.seen[i]) * lanes_.ni[i];
        }
        sum_.add(weight, lanes_.no, lanes_.ni, lanes_.rougher, count);
        for (const Group& group : std::span(groups_).first(group_count_)) {
            const float light = sum_of(sum_.reflected(), group);
            const SampleMask seen_by = group.facet->seen_by;
            light_.add(*group.facet, light);
            all_ += light;
            halves_ += light * (seen_by != 0 ? frame_.samples.halves(seen_by) : at_.halves);
        }
        lanes_.count = group_count_ = 0;
    }
};

}  // namespace

void FacetLight::add(const Facet& facet, float light) {
    if (!(light > share.back())) return;
    std::size_t place = share.size() - 1;
    for (; place > 0 && light > share[place - 1]; --place)
        share[place] = share[place - 1], brightest[place] = brightest[place - 1];
    share[place] = light, brightest[place] = &facet;
}

// Member by member: a Facet that is made first and copied then waits for its own stores.
void FacetList::push(Vec3f geometric_normal, Vec3f normal, Vec3f start_m, float samples, SampleMask seen_by,
                     const LevelFacets* flattened, Vertex& vertex) {
    Facet& added = facets_[count_++];
    added.geometric_normal = geometric_normal;
    added.normal = normal;
    added.start_m = start_m;
    added.samples = samples;
    added.seen_by = seen_by;
    added.flattened = flattened;
    added.next = vertex.facets;
    vertex.facets = &added;
}

void FacetList::add(const FrameView& frame, const Facet& part, std::uint32_t triangle, bool first,
                    Vertex& vertex) {
    const ObjectSurfaces& object = *(*frame.objects)[vertex.object];
    float flattened = 0;
    const LevelFacets* wrinkles = nullptr;
    if (!object.facets.empty()) {
        flattened = object.flattened_alpha[vertex.surface_number];
        if (!object.facets[triangle].is_flat()) wrinkles = &object.facets[triangle];
        const float alpha = vertex.surface.alpha;
        if (first && flattened > 0)
            vertex.facet_alpha = std::sqrt(std::max(0.0f, alpha * alpha - flattened * flattened));
    }
    const bool alike = first || dot(vertex.normal, part.normal) > kSame;
    if (alike && !wrinkles && flattened == 0 && !vertex.facets) return;
    if (!first && !vertex.facets)
        push(vertex.geometric_normal, vertex.normal, vertex.start(), vertex.weight_samples, vertex.samples,
             nullptr, vertex);
    push(part.geometric_normal, part.normal, part.start_m, part.samples, part.seen_by, wrinkles, vertex);
}

FacetLight lit_facets(const FrameView& frame, const Vertex& at, const Scatterer& surface, Vec3f dir) {
    return Reflection(frame, at, surface, dir).of_all();
}

}  // namespace hilcam
