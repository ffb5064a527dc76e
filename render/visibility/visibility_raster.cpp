#include "render/visibility/visibility_raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/visibility/visibility_raster.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "render/visibility/sixteen_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hilcam {
namespace HWY_NAMESPACE {

static_assert(kTrianglesAtOnce == 16);
constexpr int kSide_px = kVisibilityTile_px;
constexpr float kPlace_px = 1e-3f;      // ten times what corners are rounded by
constexpr float kEdge_px = 0.01f;       // ten times what edges are rounded by
constexpr float kFarBeside_px = 16384;  // where floats still tell a thousandth of a pixel

void project(std::span<const Vec3f> vertices_m, const ScreenProjection& p, ScreenVertex* out) {
    const Floats d;
    const std::size_t lanes = hn::Lanes(d);
    const auto number = [&](float value) { return hn::Set(d, value); };
    const auto project_some = [&](V x, V y, V z, float* to) {
        const auto row = [&](Vec3f r) {
            return times_plus(number(r.z), z, times_plus(number(r.y), y, hn::Mul(number(r.x), x)));
        };
        const V across = row(p.axes.x), down = row(p.axes.y), ahead = row(p.axes.z);
        const V z_m = hn::Add(ahead, number(p.distance));
        const V inverse = hn::Div(number(1), z_m);
        const V scale = hn::Mul(number(p.focal_px), inverse);
        const auto place = [&](V q, float lean, float start, float offset) {
            const V shifted = hn::Add(times_plus(number(lean), ahead, q), number(start));
            return times_plus(shifted, scale, number(offset));
        };
        const V sx = place(across, p.lean_x, p.start_x, p.offset_x);
        const V sy = place(down, p.lean_y, p.start_y, p.offset_y);
        const auto shown = hn::And(
            hn::Gt(z_m, number(0)),
            hn::And(hn::Lt(hn::Abs(sx), number(kFarBeside_px)), hn::Lt(hn::Abs(sy), number(kFarBeside_px))));
        hn::StoreInterleaved4(hn::IfThenElse(shown, sx, number(std::numeric_limits<float>::quiet_NaN())), sy,
                              hn::Neg(hn::Mul(hn::Add(ahead, number(p.beyond_origin)), inverse)), hn::Zero(d),
                              d, to);
    };
    const auto* in = reinterpret_cast<const float*>(vertices_m.data());
    std::size_t i = 0;
    V x, y, z;
    for (; i + lanes <= vertices_m.size(); i += lanes) {
        hn::LoadInterleaved3(d, in + 3 * i, x, y, z);
        project_some(x, y, z, &out[i].x);
    }
    if (i == vertices_m.size()) return;
    HWY_ALIGN float rest[3 * kTrianglesAtOnce] = {};
    HWY_ALIGN ScreenVertex results[kTrianglesAtOnce];
    std::copy(in + 3 * i, in + 3 * vertices_m.size(), rest);
    hn::LoadInterleaved3(d, rest, x, y, z);
    project_some(x, y, z, &results[0].x);
    std::copy_n(results, vertices_m.size() - i, out + i);
}

// The corners of some triangles.
struct Corners {
    V x[3], y[3], depth[3];
};
// number_of(k): of triangle k.
template <class NumberOf>
HWY_INLINE Corners corners_of(const ScreenVertex* vertices, const TriangleCorners* triangles,
                              const NumberOf& number_of) {
    Corners out;
    for (std::size_t i = 0; i < 3; ++i)
        three_of_four([&](std::size_t k) { return &vertices[triangles[number_of(k)][i]].x; }, out.x[i],
                      out.y[i], out.depth[i]);
    return out;
}
HWY_INLINE V least(const V* of) { return hn::Min(hn::Min(of[0], of[1]), of[2]); }
HWY_INLINE V most(const V* of) { return hn::Max(hn::Max(of[0], of[1]), of[2]); }

// True when a place is beside a triangle, and not by rounding.
HWY_INLINE hn::Mask<Floats> is_beside(const Corners& c, V x, V y, V place_px) {
    V side[3];
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        side[i] = hn::Sub(hn::Mul(hn::Sub(c.x[j], c.x[i]), hn::Sub(y, c.y[i])),
                          hn::Mul(hn::Sub(c.y[j], c.y[i]), hn::Sub(x, c.x[i])));
    }
    const V size = hn::Add(hn::Sub(most(c.x), least(c.x)), hn::Sub(most(c.y), least(c.y)));
    const V margin = hn::Mul(size, place_px);
    return hn::And(hn::Lt(least(side), hn::Neg(margin)), hn::Gt(most(side), margin));
}

// Moves corners from ideal places to those on the screen (LensDistortion::distorted).
HWY_INLINE void distort(const ScreenLens& lens, Corners& c) {
    const auto number = [](float value) { return hn::Set(Floats(), value); };
    const V inverse = number(1 / lens.focal_px);
    for (std::size_t i = 0; i < 3; ++i) {
        const V x = hn::Mul(hn::Sub(c.x[i], number(lens.center_x)), inverse);
        const V y = hn::Mul(hn::Sub(c.y[i], number(lens.center_y)), inverse);
        const V xx = hn::Mul(x, x), yy = hn::Mul(y, y), xy = hn::Mul(x, y), r2 = hn::Add(xx, yy);
        const V outer = times_plus(r2, times_plus(r2, number(lens.k3), number(lens.k2)), number(lens.k1));
        const V radial = times_plus(r2, outer, number(1));
        const auto add_tangential = [&](V of, float along, V own_squared, float across) {
            const V mixed = hn::Mul(number(2 * along), xy);
            const V own = hn::Mul(number(across), times_plus(number(2), own_squared, r2));
            return hn::Add(times_plus(of, radial, mixed), own);
        };
        c.x[i] =
            times_plus(add_tangential(x, lens.p1, xx, lens.p2), number(lens.focal_px), number(lens.center_x));
        c.y[i] =
            times_plus(add_tangential(y, lens.p2, yy, lens.p1), number(lens.focal_px), number(lens.center_y));
    }
}

// The triangles as they are on the screen of a bent lens.
struct Bent {
    hn::Mask<Floats> unknown, beside_picture;
    V margin_px;
};
HWY_INLINE Bent bend(const ScreenLens& lens, Corners& c) {
    const Floats d;
    const auto number = [&](float value) { return hn::Set(d, value); };
    const V x0 = least(c.x), x1 = most(c.x), y0 = least(c.y), y1 = most(c.y);
    const auto known = hn::Not(hn::IsNaN(hn::Add(hn::Add(c.x[0], c.x[1]), c.x[2])));
    const auto beside = hn::Or(hn::Or(hn::Lt(x1, number(lens.min_x)), hn::Gt(x0, number(lens.max_x))),
                               hn::Or(hn::Lt(y1, number(lens.min_y)), hn::Gt(y0, number(lens.max_y))));
    const auto leaves = hn::Or(hn::Or(hn::Lt(x0, number(lens.min_x)), hn::Gt(x1, number(lens.max_x))),
                               hn::Or(hn::Lt(y0, number(lens.min_y)), hn::Gt(y1, number(lens.max_y))));
    const V extent = hn::Max(hn::Sub(x1, x0), hn::Sub(y1, y0));
    distort(lens, c);
    // Beside the picture the polynomial may fold back: such corners have no place.
    return {hn::Or(hn::Not(known), leaves), hn::And(known, beside),
            times_plus(hn::Mul(extent, extent), number(lens.bend_per_px),
                       number(lens.tile_error_px + kPlace_px))};
}

template <bool kBent>
std::size_t tiles_with(const ScreenVertex* vertices, std::span<const TriangleCorners> triangles,
                       std::uint32_t first, int width_px, int height_px, const ScreenLens* lens,
                       TileRange* ranges) {
    const Floats d;
    const Ints di;
    const std::size_t lanes = hn::Lanes(d);
    const V zero = hn::Zero(d);
    std::size_t count = 0;
    for (std::size_t t = 0; t < triangles.size(); t += lanes) {
        const std::size_t last = triangles.size() - 1;
        Corners c =
            corners_of(vertices, triangles.data(), [&](std::size_t k) { return std::min(t + k, last); });
        const V sum = hn::Add(hn::Add(c.x[0], c.x[1]), c.x[2]);
        auto unknown = hn::IsNaN(sum);
        auto outside = unknown;  // used with a bent lens only
        V place_px = hn::Set(d, kPlace_px);
        if constexpr (kBent) {
            const Bent bent = bend(*lens, c);
            unknown = bent.unknown, outside = bent.beside_picture, place_px = bent.margin_px;
        }
        V x0 = least(c.x), x1 = most(c.x), y0 = least(c.y), y1 = most(c.y);
        if constexpr (kBent) {
            x0 = hn::Sub(x0, place_px), x1 = hn::Add(x1, place_px);
            y0 = hn::Sub(y0, place_px), y1 = hn::Add(y1, place_px);
        }
        // No sample between least and greatest, in one of the axes: seen by none.
        const V four = hn::Set(d, 4), half = hn::Set(d, 0.5f);
        const auto from = [&](V at) { return hn::Ceil(hn::Sub(hn::Mul(four, at), half)); };
        const auto to = [&](V at) { return hn::Floor(hn::Sub(hn::Mul(four, at), half)); };
        const V from_x = from(x0), to_x = to(x1), from_y = from(y0), to_y = to(y1);
        const auto none = hn::Or(hn::Gt(from_x, to_x), hn::Gt(from_y, to_y));
        // Most triangles of crumpled things, and of small ones, have one there or two each way, and beside them.
        const auto next_to = [&](V sample) { return hn::Add(sample, hn::Set(d, 1)); };
        const auto few = hn::And(hn::Ge(next_to(from_x), to_x), hn::Ge(next_to(from_y), to_y));
        const auto place_of = [&](V at) { return hn::Div(hn::Add(at, half), four); };
        const V px[] = {place_of(from_x), place_of(to_x)}, py[] = {place_of(from_y), place_of(to_y)};
        const auto beside_both = [&](V y) {
            return hn::And(is_beside(c, px[0], y, place_px), is_beside(c, px[1], y, place_px));
        };
        const auto beside = hn::And(few, hn::And(beside_both(py[0]), beside_both(py[1])));
        const V right = hn::Set(d, static_cast<float>(width_px)),
                low = hn::Set(d, static_cast<float>(height_px));
        const auto missed = hn::Or(hn::Or(none, beside), hn::Or(hn::Or(hn::Lt(x1, zero), hn::Lt(y1, zero)),
                                                                hn::Or(hn::Ge(x0, right), hn::Ge(y0, low))));
        HWY_ALIGN std::int32_t box[4][kTrianglesAtOnce];
        HWY_ALIGN float nearest[kTrianglesAtOnce];
        hn::Store(most(c.depth), d, nearest);
        const auto tile_of = [&](V at, V end) {
            const V inside = hn::Min(hn::Max(at, zero), hn::Sub(end, hn::Set(d, 1)));
            return hn::ShiftRight<4>(hn::ConvertTo(di, inside));
        };
        static_assert(kSide_px == 16);
        hn::Store(tile_of(x0, right), di, box[0]), hn::Store(tile_of(x1, right), di, box[1]);
        hn::Store(tile_of(y0, low), di, box[2]), hn::Store(tile_of(y1, low), di, box[3]);
        const unsigned unknown_bits = bits_of(d, unknown), missed_bits = bits_of(d, missed);
        const auto n = static_cast<unsigned>(std::min(lanes, triangles.size() - t));
        unsigned rest = (unknown_bits | ~missed_bits) & ((1u << n) - 1);
        if constexpr (kBent) rest &= ~bits_of(d, outside);
        for (; rest; rest &= rest - 1) {
            const auto k = static_cast<std::size_t>(__builtin_ctz(rest));
            TileRange& out = ranges[count++];
            out.triangle = first + static_cast<std::uint32_t>(t + k);
            out.x0 = static_cast<std::int16_t>(box[0][k]), out.x1 = static_cast<std::int16_t>(box[1][k]);
            out.y0 = static_cast<std::int16_t>(box[2][k]), out.y1 = static_cast<std::int16_t>(box[3][k]);
            out.nearest = nearest[k];
            if (unknown_bits >> k & 1u) out.x1 = -1, out.nearest = std::numeric_limits<float>::infinity();
        }
    }
    return count;
}

std::size_t tiles(const ScreenVertex* vertices, std::span<const TriangleCorners> triangles,
                  std::uint32_t first, int width_px, int height_px, const ScreenLens* lens,
                  TileRange* ranges) {
    return lens ? tiles_with<true>(vertices, triangles, first, width_px, height_px, lens, ranges)
                : tiles_with<false>(vertices, triangles, first, width_px, height_px, lens, ranges);
}

// Bends corners in a tile, counted from its corner.
HWY_INLINE void bend_in_tile(const TileLens& lens, Corners& c) {
    const auto number = [](float value) { return hn::Set(Floats(), value); };
    const V half = number(0.5f * kSide_px);
    for (std::size_t i = 0; i < 3; ++i) {
        const V x = hn::Sub(c.x[i], number(lens.middle_x)), y = hn::Sub(c.y[i], number(lens.middle_y));
        c.x[i] = times_plus(number(lens.xx), x, times_plus(number(lens.xy), y, half));
        c.y[i] = times_plus(number(lens.yx), x, times_plus(number(lens.yy), y, half));
    }
}

void set_up(const ScreenMesh& mesh, const std::array<std::uint32_t, kTrianglesAtOnce>& numbers,
            std::size_t count, int tile_x_px, int tile_y_px, const TileLens* lens, TriangleSetup& s) {
    const Floats d;
    const Ints di;
    const std::size_t lanes = hn::Lanes(d);
    const V zero = hn::Zero(d), left = hn::Set(d, static_cast<float>(tile_x_px)),
            top = hn::Set(d, static_cast<float>(tile_y_px));
    const I sign = hn::Set(di, std::numeric_limits<std::int32_t>::min());
    s.count = count;
    for (std::size_t k = 0; k < count; k += lanes) {
        const I number = hn::LoadU(di, reinterpret_cast<const std::int32_t*>(numbers.data()) + k);
        Corners c = corners_of(mesh.vertices, mesh.triangles, [&](std::size_t i) { return numbers[k + i]; });
        if (lens)
            bend_in_tile(*lens, c);
        else
            for (int i = 0; i < 3; ++i) c.x[i] = hn::Sub(c.x[i], left), c.y[i] = hn::Sub(c.y[i], top);
        const V ux = hn::Sub(c.x[1], c.x[0]), uy = hn::Sub(c.y[1], c.y[0]);
        const V vx = hn::Sub(c.x[2], c.x[0]), vy = hn::Sub(c.y[2], c.y[0]);
        const V area = hn::Sub(hn::Mul(ux, vy), hn::Mul(uy, vx));
        const auto left_turn = hn::Gt(area, zero);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            // Both triangles of an edge take it in one order: the same numbers, to the last bit.
            const auto swap =
                hn::Or(hn::Lt(c.x[j], c.x[i]), hn::And(hn::Eq(c.x[j], c.x[i]), hn::Lt(c.y[j], c.y[i])));
            const V px = hn::IfThenElse(swap, c.x[j], c.x[i]), py = hn::IfThenElse(swap, c.y[j], c.y[i]);
            const V qx = hn::IfThenElse(swap, c.x[i], c.x[j]), qy = hn::IfThenElse(swap, c.y[i], c.y[j]);
            const V a = hn::Sub(py, qy), b = hn::Sub(qx, px);
            // 0 -: never minus zero, so that sums with it are not, either.
            const V e = hn::Sub(zero, times_plus(a, px, hn::Mul(b, py)));
            hn::Store(a, d, s.a[i].data() + k), hn::Store(b, d, s.b[i].data() + k),
                hn::Store(e, d, s.c[i].data() + k);
            const auto inside_above = hn::Xor(left_turn, swap);
            hn::Store(hn::IfThenElseZero(hn::RebindMask(di, inside_above), sign), di,
                      reinterpret_cast<std::int32_t*>(s.flip[i].data()) + k);
        }
        const V inverse = hn::Div(hn::Set(d, 1), area);
        const V du = hn::Sub(c.depth[1], c.depth[0]), dv = hn::Sub(c.depth[2], c.depth[0]);
        const V gx = hn::Mul(hn::Sub(hn::Mul(du, vy), hn::Mul(dv, uy)), inverse);
        const V gy = hn::Mul(hn::Sub(hn::Mul(dv, ux), hn::Mul(du, vx)), inverse);
        hn::Store(gx, d, s.depth_x.data() + k), hn::Store(gy, d, s.depth_y.data() + k);
        hn::Store(hn::Sub(c.depth[0], times_plus(gx, c.x[0], hn::Mul(gy, c.y[0]))), d, s.depth.data() + k);
        hn::Store(least(c.depth), d, s.min_depth.data() + k),
            hn::Store(most(c.depth), d, s.max_depth.data() + k);
        // Pixels whose samples lie between least and greatest, a little wider for what edges are rounded by.
        const V last = hn::Set(d, kSide_px - 1), beside = hn::Set(d, sample_x(0) - kEdge_px);
        const auto pixel = [&](V at) { return hn::ConvertTo(di, hn::Min(hn::Max(at, zero), last)); };
        const auto from = [&](const V* of) { return pixel(hn::Add(least(of), beside)); };
        const auto to = [&](const V* of) { return pixel(hn::Sub(most(of), beside)); };
        const auto flat = hn::RebindMask(di, hn::Eq(area, zero));
        hn::Store(from(c.x), di, s.x0.data() + k);
        hn::Store(hn::IfThenElse(flat, hn::Set(di, -1), to(c.x)), di, s.x1.data() + k);
        hn::Store(from(c.y), di, s.y0.data() + k), hn::Store(to(c.y), di, s.y1.data() + k);
        hn::Store(hn::Add(number, hn::Set(di, static_cast<std::int32_t>(mesh.first_id))), di,
                  reinterpret_cast<std::int32_t*>(s.id.data()) + k);
        if (mesh.coplanar_groups)
            for (std::size_t i = k; i < k + lanes; ++i)
                s.id[i] = mesh.first_id + mesh.coplanar_groups[numbers[i]];
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace hilcam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hilcam {

HWY_EXPORT(project);
HWY_EXPORT(tiles);
HWY_EXPORT(set_up);

void project_vertices(std::span<const Vec3f> vertices_m, const ScreenProjection& projection,
                      ScreenVertex* out) {
    HWY_DYNAMIC_DISPATCH(project)(vertices_m, projection, out);
}
std::size_t find_tiles(const ScreenVertex* vertices, std::span<const TriangleCorners> triangles,
                       std::uint32_t first, int width_px, int height_px, const ScreenLens* lens,
                       TileRange* ranges) {
    if (triangles.empty()) return 0;
    return HWY_DYNAMIC_DISPATCH(tiles)(vertices, triangles, first, width_px, height_px, lens, ranges);
}
void set_up_triangles(const ScreenMesh& mesh, const std::array<std::uint32_t, kTrianglesAtOnce>& numbers,
                      std::size_t count, int tile_x_px, int tile_y_px, const TileLens* lens,
                      TriangleSetup& setup) {
    HWY_DYNAMIC_DISPATCH(set_up)(mesh, numbers, count, tile_x_px, tile_y_px, lens, setup);
}

}  // namespace hilcam
#endif
