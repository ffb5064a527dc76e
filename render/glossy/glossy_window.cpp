#include "render/glossy/glossy_window.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/glossy/glossy_window.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>

#include "render/brdf/microfacet.h"
#include "render/visibility/lane_vectors-inl.h"
#include "render/vocabulary/lane_sum.h"

HWY_BEFORE_NAMESPACE();
namespace hilcam {
namespace HWY_NAMESPACE {

// Limits the weight of a neighbour's ray in a direction that the neighbour's lobe hardly draws; a lobe's own
// rays have a weight of at most one. Without this limit p99 of Hubble by the Earth's light is 25.5 instead of
// 24.3 sensor noises.
constexpr float kMaxWeight = 4;
// Cosine between normals beyond which a surface has turned a corner. Without this limit light between two
// walls of one surface is 10 % low instead of 4 %.
constexpr float kFacing = 0.5f;
// A ray that starts at this share of the mean distance at which rays meet something has no weight: a near
// thing hides different places for neighbouring pixels. Without this limit light leaks past edges: Kepler's
// p99 is 21 instead of 16 sensor noises. With a half its rms is 3.5, with a quarter 3.05, and Hubble's grows
// beyond.
constexpr float kOfDistance = 4;

constexpr std::size_t kLanes = WeighedRays::kLanes;
constexpr std::size_t kVectors = kLanes / hn::MaxLanes(Floats());

// A sum of sixteen lanes, so that every vector width adds in the same order.
struct LaneSum {
    V part[kVectors];

    HWY_INLINE LaneSum() {
        for (V& of : part) of = number(0);
    }
    HWY_INLINE void add(std::size_t vector, V value) { part[vector] = hn::Add(part[vector], value); }
    HWY_INLINE float total() const {
        alignas(64) std::array<float, kLanes> lanes;
        for (std::size_t i = 0; i < kVectors; ++i)
            hn::Store(part[i], Floats(), lanes.data() + i * hn::Lanes(Floats()));
        return lane_sum(lanes);
    }
};

// The rays that a lobe takes, before they have weights.
struct Taken {
    using Column = WeighedRays::Column;
    alignas(64) Column x, y, z;  // from the lobe's point to the place that is met, or direction
    alignas(64) Column hit;      // 1 if something is met, else 0; later divided by its distance
    alignas(64) Column pixel;    // weight of the pixel
    alignas(64) Column per_density_sr;
    alignas(64) Column squared_m2;  // squared distance from the lobe's point to where the ray starts
};

HWY_INLINE Vector load_unaligned(const float* x, const float* y, const float* z, std::size_t i) {
    const Floats d;
    return {hn::LoadU(d, x + i), hn::LoadU(d, y + i), hn::LoadU(d, z + i)};
}
HWY_INLINE Vector same(Vec3f v) { return {number(v.x), number(v.y), number(v.z)}; }

// Takes the rays of ranges that belong to the lobe's surface and start near it. Returns their number.
HWY_INLINE std::size_t take(const GlossyColumns& c, std::span<const GlossyRange> ranges,
                            const GlossyPoint& lobe, int column_px, Taken& taken, WeighedRays& out) {
    const Floats d;
    const hn::RebindToUnsigned<Floats> dw;
    // Neighbours are a pixel's width apart, or farther on an oblique surface.
    const float apart_m = static_cast<float>(lobe.reach_px) * lobe.footprint_m /
                          std::max(dot(lobe.normal, lobe.view_dir), 0.1f);
    const V farthest = number(2 * apart_m * apart_m), facing = number(kFacing);
    const V per_px = number(1 / static_cast<float>(lobe.reach_px));
    const V column = number(static_cast<float>(column_px));
    const Vector point = same(lobe.point_m), normal = same(lobe.normal);
    const auto object = hn::Set(dw, lobe.object), side = hn::Set(dw, glossy_side(lobe.surface, lobe.back));
    std::size_t count = 0;
    for (const GlossyRange& range : ranges)
        for (std::size_t i = range.first; i < range.end && count < WeighedRays::kMax - kLanes;
             i += hn::Lanes(d)) {
            const Vector way = minus(load_unaligned(c.start_x, c.start_y, c.start_z, i), point);
            const V squared = dotted(way, way);
            const V turned = dotted(load_unaligned(c.normal_x, c.normal_y, c.normal_z, i), normal);
            const auto on_surface =
                hn::And(hn::Eq(hn::LoadU(dw, c.object + i), object), hn::Eq(hn::LoadU(dw, c.side + i), side));
            const auto near = hn::And(hn::Le(squared, farthest), hn::Ge(turned, facing));
            const auto taken_lanes =
                hn::And(hn::FirstN(d, range.end - i), hn::And(hn::RebindMask(d, on_surface), near));
            const V off = hn::Abs(hn::Sub(hn::LoadU(d, c.column_px + i), column));
            const V pixel = hn::Mul(number(range.row_weight), hn::Sub(number(1), hn::Mul(per_px, off)));
            const V hit = hn::LoadU(d, c.hit + i);
            const Vector to = minus(load_unaligned(c.met_x, c.met_y, c.met_z, i), times(hit, point));
            const auto keep = [&](V value, Taken::Column& column_of) HWY_ATTR {
                hn::CompressStore(value, taken_lanes, d, column_of.data() + count);
            };
            keep(to.x, taken.x), keep(to.y, taken.y), keep(to.z, taken.z);
            keep(hit, taken.hit), keep(pixel, taken.pixel), keep(squared, taken.squared_m2);
            keep(hn::LoadU(d, c.per_density_sr + i), taken.per_density_sr);
            const auto index = hn::Iota(dw, static_cast<std::uint32_t>(i));
            count += hn::CompressStore(index, hn::RebindMask(dw, taken_lanes), dw, out.ray.data() + count);
        }
    return count;
}

// GgxLobe by lanes.
struct Lobe {
    V alpha_squared, rest, no, masked_o;

    HWY_INLINE explicit Lobe(const GgxLobe& of)
        : alpha_squared(number(of.alpha_squared)),
          rest(number(1 - of.alpha_squared)),
          no(number(of.no)),
          masked_o(number(of.masked_o)) {}
    HWY_INLINE V at(V ni, V io) const {
        const V half = hn::Max(hn::Add(number(2), hn::Mul(number(2), io)), number(1e-6f));
        const V sum = hn::Add(no, ni), nh = hn::Min(hn::Mul(sum, sum), half);
        const V t = hn::Sub(half, hn::Mul(nh, rest));
        const V masked_i = hn::Sqrt(times_plus(hn::Mul(ni, ni), rest, alpha_squared));
        const V under = hn::Mul(hn::Mul(number(kPiF), hn::Mul(t, t)),
                                hn::Add(hn::Mul(ni, masked_o), hn::Mul(no, masked_i)));
        return hn::Div(hn::Mul(hn::Mul(number(0.5f), alpha_squared), hn::Mul(half, half)), under);
    }
};

// Weights what was taken by the lobe's reflection over the density of each direction. Lanes past the last one
// get no weight. Returns the weighted mean of one over the distance.
HWY_INLINE float weigh(const GlossyPoint& lobe, Taken& taken, WeighedRays& out) {
    const Floats d;
    const V zero = number(0);
    const Lobe law(GgxLobe(lobe.alpha, std::max(dot(lobe.normal, lobe.view_dir), 1e-2f)));
    const Vector normal = same(lobe.normal), view = same(lobe.view_dir);
    LaneSum all, per_distance;
    for (std::size_t first = 0; first < out.count; first += kLanes)
        for (std::size_t k = 0; k < kVectors; ++k) {
            const std::size_t i = first + k * hn::Lanes(d);
            const Vector to{hn::Load(d, taken.x.data() + i), hn::Load(d, taken.y.data() + i),
                            hn::Load(d, taken.z.data() + i)};
            const V per_length = hn::Div(number(1), hn::Sqrt(hn::Max(dotted(to, to), number(1e-30f))));
            const V ni = hn::Mul(dotted(normal, to), per_length), io = hn::Mul(dotted(view, to), per_length);
            const V pixel = hn::Load(d, taken.pixel.data() + i);
            const V reflected = hn::Mul(hn::Max(ni, zero), law.at(hn::Max(ni, number(1e-3f)), io));
            const V drawn = hn::Mul(pixel, hn::Load(d, taken.per_density_sr.data() + i));
            const V limited = hn::Min(hn::Mul(drawn, reflected), hn::Mul(number(kMaxWeight), pixel));
            const auto used = hn::FirstN(d, out.count > i ? out.count - i : 0);
            const V weight = hn::IfThenElseZero(used, limited);
            const V near = hn::IfThenElseZero(used, hn::Mul(hn::Load(d, taken.hit.data() + i), per_length));
            hn::Store(weight, d, out.weight.data() + i);
            all.add(k, weight), per_distance.add(k, hn::Mul(weight, near));
        }
    const float sum = all.total();
    return sum > 0 ? per_distance.total() / sum : 0.0f;
}

// Takes weight from rays that start too far away.
HWY_INLINE void leave_out_far(const Taken& taken, WeighedRays& out) {
    const Floats d;
    const V per_way = number(kOfDistance * out.per_distance);
    LaneSum all, squares;
    for (std::size_t first = 0; first < out.count; first += kLanes)
        for (std::size_t k = 0; k < kVectors; ++k) {
            const std::size_t i = first + k * hn::Lanes(d);
            const auto used = hn::FirstN(d, out.count > i ? out.count - i : 0);
            const V way = hn::Sqrt(hn::IfThenElseZero(used, hn::Load(d, taken.squared_m2.data() + i)));
            const V left = hn::Max(hn::Sub(number(1), hn::Mul(per_way, way)), number(0));
            const V weight = hn::Mul(hn::Load(d, out.weight.data() + i), left);
            hn::Store(weight, d, out.weight.data() + i);
            all.add(k, weight), squares.add(k, hn::Mul(weight, weight));
        }
    out.all = all.total(), out.squares = squares.total();
}

// Sums what the rays bring. Four sums in turns do not wait for each other.
HWY_INLINE void add_up(const GlossyColumns& columns, WeighedRays& out) {
    const Floats d;
    constexpr std::size_t kSums = 4;
    V sums[kSums][kVectors];
    for (auto& sum : sums)
        for (V& part : sum) part = number(0);
    std::size_t turn = 0;
    for (std::size_t i = 0; i < out.count; ++i) {
        if (!(out.weight[i] > 0)) continue;
        const V weight = number(out.weight[i]);
        const auto* const of = reinterpret_cast<const float*>(columns.sum + out.ray[i]);
        for (std::size_t k = 0; k < kVectors; ++k)
            sums[turn][k] = times_plus(weight, hn::Load(d, of + k * hn::Lanes(d)), sums[turn][k]);
        turn = (turn + 1) % kSums;
    }
    auto* const to = reinterpret_cast<float*>(&out.sum);
    for (std::size_t k = 0; k < kVectors; ++k)
        hn::Store(hn::Add(hn::Add(sums[0][k], sums[1][k]), hn::Add(sums[2][k], sums[3][k])), d,
                  to + k * hn::Lanes(d));
}

void weigh_rays(const GlossyColumns& columns, std::span<const GlossyRange> ranges, const GlossyPoint& lobe,
                int column_px, WeighedRays& out) {
    Taken taken;
    out.count = take(columns, ranges, lobe, column_px, taken, out);
    out.per_distance = weigh(lobe, taken, out);
    leave_out_far(taken, out);
    add_up(columns, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace hilcam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hilcam {

HWY_EXPORT(weigh_rays);

void weigh_rays(const GlossyColumns& columns, std::span<const GlossyRange> ranges, const GlossyPoint& lobe,
                int column_px, WeighedRays& out) {
    HWY_DYNAMIC_DISPATCH(weigh_rays)(columns, ranges, lobe, column_px, out);
}

}  // namespace hilcam
#endif
