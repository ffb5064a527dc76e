// What of the kept light a facet lobe finds: KeptLight's lookup.

#include <algorithm>
#include <bit>
#include <cmath>

#include "render/light/kept_light.h"
#include "render/vocabulary/clones.h"

namespace hilcam {
namespace {

// A lobe in a node's axes, and the sums of its weights.
struct LobeQuery {
    Vec3f normal, view, mirror;
    float no, alpha;
    float whole, kept;
};

// The weight of each direction: whole, of a lobe without Fresnel's term; kept, without what rays follow of a
// narrow one. counts: 0 for directions that only fill up. n is a multiple of sixteen.
HILCAM_CLONES
void lobe_weights(const float* x, const float* y, const float* z, const float* counts, std::size_t n,
                  LobeQuery& query, float* whole, float* kept) {
    // A narrow lobe's tails begin 15 degrees from the mirror's direction and are whole at 30.
    constexpr float kNone = 0.966f, kWhole = 0.866f;
    const bool narrow = query.alpha < kNarrowestKept;
    const Vec3f m = query.normal, v = query.view, r = query.mirror;
    const float no = query.no, a2 = query.alpha * query.alpha;
    const float masked_o = std::sqrt(no * no * (1 - a2) + a2);
    for (std::size_t d = 0; d < n; ++d) {
        const float ni = x[d] * m.x + y[d] * m.y + z[d] * m.z;
        const float io = x[d] * v.x + y[d] * v.y + z[d] * v.z;
        const float off = x[d] * r.x + y[d] * r.y + z[d] * r.z;
        const float above = ni > 0 ? counts[d] : 0.0f, safe = std::max(ni, 1e-3f);
        // This is ggx_distribution() and ggx_visibility() of brdf_microfacet.h, without branches.
        const float nh2 = std::min((no + ni) * (no + ni) / std::max(2 + 2 * io, 1e-6f), 1.0f);
        const float t = nh2 * (a2 - 1) + 1;
        const float masked_i = std::sqrt(safe * safe * (1 - a2) + a2);
        whole[d] = above * a2 / (kPiF * t * t) * 0.5f / (safe * masked_o + no * masked_i);
        const float tail = std::min(std::max((kNone - off) * (1 / (kNone - kWhole)), 0.0f), 1.0f);
        kept[d] = narrow ? whole[d] * tail : whole[d];
    }
    for (std::size_t d = 0; d < n; ++d) query.whole += whole[d], query.kept += kept[d];
}

}  // namespace

KeptLight::Lobe KeptLight::lobe(const KeptTerm* sun, std::uint32_t n, Vec3f normal, Vec3f view_dir,
                                float alpha) const {
    if (all_free(n)) return {};
    const Local axes = local(n);
    LobeQuery query{axes.dir(normal),
                    axes.dir(view_dir),
                    axes.dir(reflect(view_dir, normal)),
                    std::max(dot(normal, view_dir), 1e-2f),
                    alpha,
                    0,
                    0};
    alignas(64) std::array<float, kMostDirections> whole, kept;  // weights, by direction
    lobe_weights(local_x_.data(), local_y_.data(), local_z_.data(), counts_.data(), counts_.size(), query,
                 whole.data(), kept.data());
    // Points that are buried do not count.
    const std::size_t of_point = table_->directions_of_point();
    for (std::size_t p = 0; p < LightNode::kPoints; ++p)
        for (std::size_t d = p * of_point; !table_->is_live(n, p) && d < (p + 1) * of_point; ++d) {
            query.whole -= whole[d], query.kept -= kept[d];
            whole[d] = kept[d] = 0;
        }
    Lobe out;
    if (!(query.whole > 0)) return out;
    // Sixty directions are too few for a sum over a lobe; for its tails they are enough.
    const float all =
        alpha < kNarrowestKept ? static_cast<float>(table_->counted(n)) / kPiF : std::max(query.kept, 1e-20f);
    float met = 0;
    for_each_met(n, [&](std::size_t d) { met += whole[d]; });
    const PackedSpectrum* along = sun ? sun->along.data() + first_along_[n] : nullptr;
    float occupied = 0;
    for (const TransferTable::Entry e : table_->entries(n)) {
        occupied += kept[e.direction];
        if (along) out.kept += kept[e.direction] * (along++)->unpacked();
    }
    out.kept = (1 / all) * out.kept;
    out.free = std::clamp(1 - met / query.whole, 0.0f, 1.0f);
    out.occupied = occupied / all;
    return out;
}

// visit(direction) where a node's direction meets something, be it dark.
template <class Visit>
void KeptLight::for_each_met(std::size_t n, const Visit& visit) const {
    const auto directions = static_cast<std::size_t>(table_->directions());
    const std::span<const std::uint64_t> free = table_->free(n);
    for (std::size_t w = 0; w < free.size(); ++w) {
        const std::size_t bits = std::min<std::size_t>(64, directions - 64 * w);
        std::uint64_t met = ~free[w] & (bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1);
        for (; met != 0; met &= met - 1) visit(64 * w + static_cast<std::size_t>(std::countr_zero(met)));
    }
}

bool KeptLight::all_free(std::size_t n) const {
    int free = 0;
    for (const std::uint64_t word : table_->free(n)) free += std::popcount(word);
    return free == table_->directions();
}

bool KeptLight::is_near(std::uint32_t n, Vec3f dir) const {
    if (all_free(n)) return false;
    constexpr float kNear = 0.88f;  // 28 degrees: further than the next direction
    const Vec3f l = local(n).dir(dir);
    bool near = false;
    for_each_met(n, [&](std::size_t d) {
        near = near || (local_x_[d] * l.x + local_y_[d] * l.y + local_z_[d] * l.z > kNear &&
                        table_->is_live(n, table_->point_of(d)));
    });
    return near;
}

}  // namespace hilcam
