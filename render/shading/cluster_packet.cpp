#include "render/shading/cluster_packet.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/shading/cluster_packet.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "render/visibility/lane_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hilcam {
namespace HWY_NAMESPACE {

constexpr std::size_t kParts = ClusterPacket::kParts;

HWY_INLINE V load(const ClusterPacket::Floats& from, std::size_t k) {
    return hn::Load(Floats(), from.data() + k);
}
HWY_INLINE Vector load(const ClusterPacket::Vectors& from, std::size_t k) {
    return {load(from.x, k), load(from.y, k), load(from.z, k)};
}
HWY_INLINE void store(V v, ClusterPacket::Floats& to, std::size_t k) {
    hn::Store(v, Floats(), to.data() + k);
}

// The LOD normals of each cluster: leans (body axes), weights, and the squared alpha of their scatter.
struct Parts {
    Vector lean[kParts];
    V share[kParts];
    V rougher;

    // from: one entry for each lane of a vector.
    HWY_INLINE Parts(const LodNormals* from, V side) {
        const Floats d;
        const Ints di;
        const auto* words = reinterpret_cast<const std::int32_t*>(from);
        I a[4], b[4];
        hn::LoadInterleaved4(di, words, a[0], a[1], a[2], a[3]);
        hn::LoadInterleaved4(di, words + 4 * hn::Lanes(di), b[0], b[1], b[2], b[3]);
        const auto even = [&](int i) HWY_ATTR { return hn::ConcatEven(di, b[i], a[i]); };
        const auto odd = [&](int i) HWY_ATTR { return hn::ConcatOdd(di, b[i], a[i]); };
        const V scale = hn::Mul(side, number(1 / LodNormals::kLean));
        const auto set = [&](V Vector::*axis, std::size_t pair, I both) HWY_ATTR {
            const I low = hn::ShiftRight<16>(hn::ShiftLeft<16>(both)), high = hn::ShiftRight<16>(both);
            lean[2 * pair].*axis = hn::Mul(hn::ConvertTo(d, low), scale);
            lean[2 * pair + 1].*axis = hn::Mul(hn::ConvertTo(d, high), scale);
        };
        set(&Vector::x, 0, even(0)), set(&Vector::x, 1, even(1));
        set(&Vector::y, 0, even(2)), set(&Vector::y, 1, even(3));
        set(&Vector::z, 0, odd(0)), set(&Vector::z, 1, odd(1));
        const I shares = odd(2), byte = hn::Set(di, 255);
        const auto share_of = [&](I of) HWY_ATTR {
            return hn::Mul(hn::ConvertTo(d, hn::And(of, byte)), number(1 / LodNormals::kAll));
        };
        share[0] = share_of(shares), share[1] = share_of(hn::ShiftRight<8>(shares));
        share[2] = share_of(hn::ShiftRight<16>(shares)), share[3] = share_of(hn::ShiftRight<24>(shares));
        const V alpha = hn::BitCast(d, odd(3));
        rougher = hn::Mul(alpha, alpha);
    }
};

HWY_INLINE Vector turned(const Mat3f& m, const Vector& a) {
    const auto row = [&](Vec3f r) HWY_ATTR {
        return hn::Add(hn::Add(hn::Mul(number(r.x), a.x), hn::Mul(number(r.y), a.y)),
                       hn::Mul(number(r.z), a.z));
    };
    return {row(m.x), row(m.y), row(m.z)};
}

// Weights the LOD normals of clusters by how much the viewer sees of them and by the incident light.
//
// Wrinkles shade each other, most for grazing light: together they receive as much light as the flat
// triangle, whatever their sides face (the condition from which Smith's shadowing is derived: Heitz, JCGT
// 3(2), 2014, section 2). The factor exceeds 1 where they lean away from the light; it is limited, because
// the triangle has an error of its own.
HWY_INLINE void weigh(const Mat3f& world_from_body, const Parts& parts, std::size_t k, ClusterPacket& p) {
    const V zero = number(0), one = number(1);
    const Vector normal = load(p.normal, k), view = load(p.view, k), light = load(p.light, k);
    V seen[kParts], ni[kParts], all_seen = zero, all_lit = zero;
    Vector area{zero, zero, zero};
    for (std::size_t j = 0; j < kParts; ++j) {
        const Vector at = plus(normal, turned(world_from_body, parts.lean[j]));
        const V inverse = hn::Div(one, hn::Sqrt(hn::Max(dotted(at, at), number(1e-12f))));
        const V no = hn::Mul(inverse, dotted(at, view));
        ni[j] = hn::Max(hn::Mul(inverse, dotted(at, light)), zero);
        seen[j] = hn::Mul(parts.share[j], hn::Max(no, zero));
        area = plus(area, times(hn::Mul(parts.share[j], inverse), at));
        all_seen = hn::Add(all_seen, seen[j]), all_lit = hn::Add(all_lit, hn::Mul(parts.share[j], ni[j]));
        store(hn::Max(no, number(1e-4f)), p.no[j], k), store(ni[j], p.ni[j], k);
    }
    constexpr float kMax = 2;
    const V flat = load(p.flat, k);
    const auto shaded = hn::And(hn::Gt(all_lit, zero), hn::Gt(flat, zero));
    const V share = hn::Min(hn::Div(hn::Mul(flat, hn::Sqrt(dotted(area, area))), all_lit), number(kMax));
    // A cluster that faces away from the viewer as a whole is weighted by area.
    const auto hidden = hn::Not(hn::Gt(all_seen, zero));
    const V each = hn::Div(hn::Mul(hn::IfThenElse(shaded, share, one), load(p.samples, k)),
                           hn::IfThenElse(hidden, one, all_seen));
    V lit = zero;
    for (std::size_t j = 0; j < kParts; ++j) {
        const V weight = hn::Mul(hn::Mul(each, hn::IfThenElse(hidden, parts.share[j], seen[j])), ni[j]);
        lit = hn::Add(lit, weight);
        store(weight, p.weight[j], k);
    }
    store(lit, p.lit, k);
}

// LobeAlbedo by lanes.
class Albedos {
  public:
    HWY_INLINE explicit Albedos(const LobeAlbedo& of) : table_(of.at_cosine.data()) {
        if constexpr (kInRegisters)
            for (int i = 0; i < 2; ++i) {
                const float* const from = table_ + i * kHalf;
                low_[i] = hn::LoadU(Floats(), from);
                more_[i] = hn::Sub(hn::LoadU(Floats(), from + 1), low_[i]);
            }
    }
    // cosine: not below zero.
    HWY_INLINE V of(V cosine) const {
        const Floats d;
        const Ints di;
        const V x = hn::Mul(hn::Min(cosine, number(1)), number(LobeAlbedo::kSteps));
        const I step = hn::Min(hn::ConvertTo(di, x), hn::Set(di, LobeAlbedo::kSteps - 1));
        const V rest = hn::Sub(x, hn::ConvertTo(d, step));
        if constexpr (kInRegisters) {
            const auto index = hn::IndicesFromVec(d, hn::And(step, hn::Set(di, kHalf - 1)));
            const auto upper = hn::RebindMask(d, hn::Gt(step, hn::Set(di, kHalf - 1)));
            const auto find = [&](const V(&halves)[2]) HWY_ATTR {
                return hn::IfThenElse(upper, hn::TableLookupLanes(halves[1], index),
                                      hn::TableLookupLanes(halves[0], index));
            };
            return hn::Add(find(low_), hn::Mul(rest, find(more_)));
        } else {
            const V low = hn::GatherIndex(d, table_, step), high = hn::GatherIndex(d, table_ + 1, step);
            return hn::Add(low, hn::Mul(rest, hn::Sub(high, low)));
        }
    }

  private:
    static constexpr int kHalf = LobeAlbedo::kSteps / 2;
    // Two vectors hold the table.
    static constexpr bool kInRegisters = hn::MaxLanes(Floats()) == kHalf;
    const float* table_;
    V low_[2], more_[2];
};

// Slopes s with the density a^2 / (pi (a^2 + s^2)^2) (GGX's: Heitz, JCGT 3(2), 2014) are scattered by r. To
// first order the density changes by the relative amount r (4 s^2 - 2 a^2) / (a^2 + s^2)^2. A lobe whose a^2
// grows by 4 r a^2 / (2 a^2 + s^2) has this change in its middle, and in its tails, which hardly change. Then
// ggx_distribution() times ggx_visibility(), with one division.
HWY_INLINE V lobe_of(V alpha_squared, V rougher, V over_half, V no, V ni) {
    const V one = number(1);
    const V nh = hn::Min(hn::Mul(hn::Add(no, ni), over_half), one), squared = hn::Mul(nh, nh);
    const V both = hn::Add(alpha_squared, rougher), both_there = hn::Mul(both, squared);
    const V wider = hn::Div(hn::Mul(hn::Mul(number(4), rougher), both_there),
                            hn::Add(hn::Mul(number(2), both_there), hn::Sub(one, squared)));
    const V a2 = hn::Min(hn::Add(alpha_squared, wider), one), rest = hn::Sub(one, a2);
    const auto masked = [&](V cosine) HWY_ATTR {
        return hn::Sqrt(hn::Add(hn::Mul(hn::Mul(cosine, cosine), rest), a2));
    };
    const V t = hn::Sub(one, hn::Mul(squared, rest));
    const V under = hn::Add(hn::Mul(ni, masked(no)), hn::Mul(no, masked(ni)));
    return hn::Div(hn::Mul(number(0.5f), a2), hn::Mul(hn::Mul(number(kPiF), hn::Mul(t, t)), under));
}

HWY_INLINE void reflect_parts(const Albedos& albedos, V per_below, V rougher, std::size_t k,
                              ClusterPacket& p) {
    const V one = number(1), alpha_squared = load(p.alpha_squared, k), over_half = load(p.over_half, k);
    V below = number(0), lobe = number(0);
    for (std::size_t j = 0; j < kParts; ++j) {
        const V weight = load(p.weight[j], k), no = load(p.no[j], k), ni = load(p.ni[j], k);
        const V entered = hn::Mul(hn::Sub(one, albedos.of(no)), hn::Sub(one, albedos.of(ni)));
        below = hn::Add(below, hn::Mul(weight, hn::Mul(entered, per_below)));
        const V by_lobe = lobe_of(alpha_squared, rougher, over_half, no, hn::Max(ni, number(1e-6f)));
        lobe = hn::Add(lobe, hn::Mul(weight, by_lobe));
    }
    store(below, p.below, k), store(lobe, p.lobe, k);
}

void reflect(const Mat3f& world_from_body, const LobeAlbedo* facets, ClusterPacket& p) {
    static constexpr LobeAlbedo kNone;
    const LobeAlbedo& law = facets ? *facets : kNone;
    const Albedos albedos(law);
    // below_facets().
    const V per_below = number(law.average < 0.9999f ? 1 / (kPiF * (1 - law.average)) : 0.0f);
    for (std::size_t k = 0; k < p.count; k += hn::Lanes(Floats())) {
        const Parts parts(p.parts.data() + k, load(p.side, k));
        weigh(world_from_body, parts, k, p);
        if (facets) reflect_parts(albedos, per_below, parts.rougher, k, p);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace hilcam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hilcam {

HWY_EXPORT(reflect);

void reflect_clusters(const Mat3f& world_from_body, const LobeAlbedo* facets, ClusterPacket& packet) {
    HWY_DYNAMIC_DISPATCH(reflect)(world_from_body, facets, packet);
}

}  // namespace hilcam
#endif
