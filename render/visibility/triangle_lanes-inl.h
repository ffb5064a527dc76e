// Several triangles on the screen, one per lane, for code that is compiled for several vector widths: which
// tiles may show them, and their set-up for a tile. Included once per width, like Highway's own headers.

#if defined(HILCAM_TRIANGLE_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HILCAM_TRIANGLE_LANES_INL_H
#undef HILCAM_TRIANGLE_LANES_INL_H
#else
#define HILCAM_TRIANGLE_LANES_INL_H
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <limits>
#include <span>
#include <type_traits>

#include "render/visibility/sixteen_lanes-inl.h"
#include "render/visibility/visibility_raster.h"

HWY_BEFORE_NAMESPACE();
namespace hilcam {
namespace HWY_NAMESPACE {

static_assert(kTrianglesAtOnce == 16);
constexpr int kSide_px = kVisibilityTile_px;
constexpr float kPlace_px = 1e-3f;      // ten times the rounding of corners
constexpr float kEdge_px = 0.01f;       // ten times the rounding of edges
constexpr float kFarBeside_px = 16384;  // floats still resolve a thousandth of a pixel here

// Vertices on the screen.
struct Projected {
    V x, y, depth;
    V z_m;  // along the camera's axis; zero or less: not on the screen
};
HWY_INLINE Projected projected(const ScreenProjection& p, V x, V y, V z) {
    const auto number = [](float value) { return hn::Set(Floats(), value); };
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
    return {place(across, p.lean_x, p.start_x, p.offset_x), place(down, p.lean_y, p.start_y, p.offset_y),
            hn::Neg(hn::Mul(hn::Add(ahead, number(p.beyond_origin)), inverse)), z_m};
}
// Writes vertices; x is NaN for a vertex that is not on the screen or is far outside the picture.
HWY_INLINE void write_vertices(const Projected& at, V speed, float* to) {
    const Floats d;
    const auto number = [&](float value) { return hn::Set(d, value); };
    const auto shown = hn::And(
        hn::Gt(at.z_m, number(0)),
        hn::And(hn::Lt(hn::Abs(at.x), number(kFarBeside_px)), hn::Lt(hn::Abs(at.y), number(kFarBeside_px))));
    hn::StoreInterleaved4(hn::IfThenElse(shown, at.x, number(std::numeric_limits<float>::quiet_NaN())), at.y,
                          at.depth, speed, d, to);
}
// Calls some(x, y, z, out) for the vertices, one per lane; it writes to out.
template <class Some>
HWY_INLINE void for_vertices(std::span<const Vec3f> vertices_m, ScreenVertex* out, const Some& some) {
    const Floats d;
    const std::size_t lanes = hn::Lanes(d);
    const auto* in = reinterpret_cast<const float*>(vertices_m.data());
    std::size_t i = 0;
    V x, y, z;
    for (; i + lanes <= vertices_m.size(); i += lanes) {
        hn::LoadInterleaved3(d, in + 3 * i, x, y, z);
        some(x, y, z, &out[i].x);
    }
    if (i == vertices_m.size()) return;
    HWY_ALIGN float rest[3 * kTrianglesAtOnce] = {};
    HWY_ALIGN ScreenVertex results[kTrianglesAtOnce];
    std::copy(in + 3 * i, in + 3 * vertices_m.size(), rest);
    hn::LoadInterleaved3(d, rest, x, y, z);
    some(x, y, z, &results[0].x);
    std::copy_n(results, vertices_m.size() - i, out + i);
}

// The corners of triangles.
struct Corners {
    V x[3], y[3], depth[3];
};
// number_of(k): number of triangle k.
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

// True when a place is outside a triangle by more than rounding.
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

// Moves ideal places to those on the screen (LensDistortion::distorted).
HWY_INLINE void distort(const ScreenLens& lens, V& place_x, V& place_y) {
    const auto number = [](float value) { return hn::Set(Floats(), value); };
    const V inverse = number(1 / lens.focal_px);
    const V x = hn::Mul(hn::Sub(place_x, number(lens.center_x)), inverse);
    const V y = hn::Mul(hn::Sub(place_y, number(lens.center_y)), inverse);
    const V xx = hn::Mul(x, x), yy = hn::Mul(y, y), xy = hn::Mul(x, y), r2 = hn::Add(xx, yy);
    const V outer = times_plus(r2, times_plus(r2, number(lens.k3), number(lens.k2)), number(lens.k1));
    const V radial = times_plus(r2, outer, number(1));
    const auto add_tangential = [&](V of, float along, V own_squared, float across) {
        const V mixed = hn::Mul(number(2 * along), xy);
        const V own = hn::Mul(number(across), times_plus(number(2), own_squared, r2));
        return hn::Add(times_plus(of, radial, mixed), own);
    };
    place_x =
        times_plus(add_tangential(x, lens.p1, xx, lens.p2), number(lens.focal_px), number(lens.center_x));
    place_y =
        times_plus(add_tangential(y, lens.p2, yy, lens.p1), number(lens.focal_px), number(lens.center_y));
}

// Triangles on the screen of a lens with distortion.
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
    for (std::size_t i = 0; i < 3; ++i) distort(lens, c.x[i], c.y[i]);
    // The polynomial may fold over outside the picture; such corners have no place.
    return {hn::Or(hn::Not(known), leaves), hn::And(known, beside),
            times_plus(hn::Mul(extent, extent), number(lens.bend_per_px),
                       number(lens.tile_error_px + kPlace_px))};
}

// The default: triangles are straight and exactly where their corners are.
struct NoMargin {};
// margin_of(t, corners): how far triangles from t on may extend beyond their corners [px]; NoMargin: not at
// all.
template <bool kBent, class MarginOf>
std::size_t tiles_with(const ScreenVertex* vertices, std::span<const TriangleCorners> triangles,
                       std::uint32_t first, int width_px, int height_px, const ScreenLens* lens,
                       const MarginOf& margin_of, TileRange* ranges) {
    constexpr bool kWider = !std::is_same_v<MarginOf, NoMargin>;
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
        auto outside = unknown;  // used only with a lens that has distortion
        V place_px = hn::Set(d, kPlace_px);
        if constexpr (kBent) {
            const Bent bent = bend(*lens, c);
            unknown = bent.unknown, outside = bent.beside_picture, place_px = bent.margin_px;
        }
        if constexpr (kWider) place_px = hn::Add(place_px, margin_of(t, c));
        V x0 = least(c.x), x1 = most(c.x), y0 = least(c.y), y1 = most(c.y);
        if constexpr (kBent || kWider) {
            x0 = hn::Sub(x0, place_px), x1 = hn::Add(x1, place_px);
            y0 = hn::Sub(y0, place_px), y1 = hn::Add(y1, place_px);
        }
        // A triangle with no sample between its least and greatest coordinate, on either axis, is not seen.
        const V four = hn::Set(d, 4), half = hn::Set(d, 0.5f);
        const auto from = [&](V at) { return hn::Ceil(hn::Sub(hn::Mul(four, at), half)); };
        const auto to = [&](V at) { return hn::Floor(hn::Sub(hn::Mul(four, at), half)); };
        const V from_x = from(x0), to_x = to(x1), from_y = from(y0), to_y = to(y1);
        const auto none = hn::Or(hn::Gt(from_x, to_x), hn::Gt(from_y, to_y));
        // Most small or crumpled triangles have one or two samples in each direction, and miss those.
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

// Applies a tile's lens to corners, relative to the tile's corner.
HWY_INLINE void bend_in_tile(const TileLens& lens, Corners& c) {
    const auto number = [](float value) { return hn::Set(Floats(), value); };
    const V half = number(0.5f * kSide_px);
    for (std::size_t i = 0; i < 3; ++i) {
        const V x = hn::Sub(c.x[i], number(lens.middle_x)), y = hn::Sub(c.y[i], number(lens.middle_y));
        c.x[i] = times_plus(number(lens.xx), x, times_plus(number(lens.xy), y, half));
        c.y[i] = times_plus(number(lens.yx), x, times_plus(number(lens.yy), y, half));
    }
}

// Moves corners from ideal places to places relative to a tile's corner.
HWY_INLINE void move_into_tile(int tile_x_px, int tile_y_px, const TileLens* lens, Corners& c) {
    if (lens) return bend_in_tile(*lens, c);
    const Floats d;
    const V left = hn::Set(d, static_cast<float>(tile_x_px)), top = hn::Set(d, static_cast<float>(tile_y_px));
    for (int i = 0; i < 3; ++i) c.x[i] = hn::Sub(c.x[i], left), c.y[i] = hn::Sub(c.y[i], top);
}

// Changes of the depth of triangles per pixel to the right and down.
struct DepthSlopes {
    V right, down;
};
HWY_INLINE DepthSlopes depth_slopes(const Corners& c, V inverse_area) {
    const V ux = hn::Sub(c.x[1], c.x[0]), uy = hn::Sub(c.y[1], c.y[0]);
    const V vx = hn::Sub(c.x[2], c.x[0]), vy = hn::Sub(c.y[2], c.y[0]);
    const V du = hn::Sub(c.depth[1], c.depth[0]), dv = hn::Sub(c.depth[2], c.depth[0]);
    return {hn::Mul(hn::Sub(hn::Mul(du, vy), hn::Mul(dv, uy)), inverse_area),
            hn::Mul(hn::Sub(hn::Mul(dv, ux), hn::Mul(du, vx)), inverse_area)};
}
HWY_INLINE V area_of(const Corners& c) {
    const V ux = hn::Sub(c.x[1], c.x[0]), uy = hn::Sub(c.y[1], c.y[0]);
    const V vx = hn::Sub(c.x[2], c.x[0]), vy = hn::Sub(c.y[2], c.y[0]);
    return hn::Sub(hn::Mul(ux, vy), hn::Mul(uy, vx));
}

// An edge function a x + b y + c, zero on the line from p to q.
struct Line {
    V a, b, c;
};
HWY_INLINE Line line_of(V px, V py, V qx, V qy) {
    const V a = hn::Sub(py, qy), b = hn::Sub(qx, px);
    // 0 - x is never minus zero, so neither are sums with it.
    return {a, b, hn::Sub(hn::Zero(Floats()), times_plus(a, px, hn::Mul(b, py)))};
}

// Triangles of a tile in which all rows have one instant.
struct OneInstant {};
// Corners of triangles, relative to a tile's corner, at the instants of the tile's upper and lower edge.
struct TwoInstants {
    Corners upper, lower;
};

// Adds, to a function that is linear on the screen, its change from row to row, as in the tile's middle.
HWY_INLINE void add_change(V upper, V lower, V& slope_down, V& at_corner) {
    const Floats d;
    const V per_row = hn::Mul(hn::Sub(lower, upper), hn::Set(d, 1.0f / kSide_px));
    slope_down = hn::Add(slope_down, per_row);
    at_corner = hn::Sub(at_corner, hn::Mul(per_row, hn::Set(d, 0.5f * kSide_px)));
}
HWY_INLINE V in_the_middle(V a, V b, V c) {
    return times_plus(hn::Add(a, b), hn::Set(Floats(), 0.5f * kSide_px), c);
}

// Sets up triangles from k on for a tile. c: corners relative to the tile's corner; rows: their motion from
// row to row.
template <class Rows>
HWY_INLINE void set_up_lanes(const ScreenMesh& mesh, const std::uint32_t* numbers, const Corners& c,
                             const Rows& rows, std::size_t k, TriangleSetup& s) {
    constexpr bool kMoves = std::is_same_v<Rows, TwoInstants>;
    const Floats d;
    const Ints di;
    const V zero = hn::Zero(d);
    const I sign = hn::Set(di, std::numeric_limits<std::int32_t>::min());
    const I number = hn::LoadU(di, reinterpret_cast<const std::int32_t*>(numbers) + k);
    const V area = area_of(c);
    const auto left_turn = hn::Gt(area, zero);
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        // Both triangles of an edge use it in the same order, and so get the same numbers to the last bit.
        const auto swap =
            hn::Or(hn::Lt(c.x[j], c.x[i]), hn::And(hn::Eq(c.x[j], c.x[i]), hn::Lt(c.y[j], c.y[i])));
        const auto line = [&](const Corners& at) {
            return line_of(hn::IfThenElse(swap, at.x[j], at.x[i]), hn::IfThenElse(swap, at.y[j], at.y[i]),
                           hn::IfThenElse(swap, at.x[i], at.x[j]), hn::IfThenElse(swap, at.y[i], at.y[j]));
        };
        Line edge = line(c);
        if constexpr (kMoves) {
            const Line upper = line(rows.upper), lower = line(rows.lower);
            add_change(in_the_middle(upper.a, upper.b, upper.c), in_the_middle(lower.a, lower.b, lower.c),
                       edge.b, edge.c);
        }
        hn::Store(edge.a, d, s.a[i].data() + k), hn::Store(edge.b, d, s.b[i].data() + k),
            hn::Store(edge.c, d, s.c[i].data() + k);
        const auto inside_above = hn::Xor(left_turn, swap);
        hn::Store(hn::IfThenElseZero(hn::RebindMask(di, inside_above), sign), di,
                  reinterpret_cast<std::int32_t*>(s.flip[i].data()) + k);
    }
    const auto depth_at_corner = [&](const Corners& at, const DepthSlopes& slopes) {
        return hn::Sub(at.depth[0], times_plus(slopes.right, at.x[0], hn::Mul(slopes.down, at.y[0])));
    };
    DepthSlopes slopes = depth_slopes(c, hn::Div(hn::Set(d, 1), area));
    V depth = depth_at_corner(c, slopes);
    V nearest = most(c.depth), farthest = least(c.depth);
    V min_x = least(c.x), max_x = most(c.x), min_y = least(c.y), max_y = most(c.y);
    if constexpr (kMoves) {
        const auto in_middle = [&](const Corners& at) {
            const DepthSlopes own = depth_slopes(at, hn::Div(hn::Set(d, 1), area_of(at)));
            return in_the_middle(own.right, own.down, depth_at_corner(at, own));
        };
        add_change(in_middle(rows.upper), in_middle(rows.lower), slopes.down, depth);
        for (const Corners* at : {&rows.upper, &rows.lower}) {
            nearest = hn::Max(nearest, most(at->depth)), farthest = hn::Min(farthest, least(at->depth));
            min_x = hn::Min(min_x, least(at->x)), max_x = hn::Max(max_x, most(at->x));
            min_y = hn::Min(min_y, least(at->y)), max_y = hn::Max(max_y, most(at->y));
        }
    }
    hn::Store(slopes.right, d, s.depth_x.data() + k);
    hn::Store(slopes.down, d, s.depth_y.data() + k);
    hn::Store(depth, d, s.depth.data() + k);
    hn::Store(farthest, d, s.min_depth.data() + k), hn::Store(nearest, d, s.max_depth.data() + k);
    // Pixels with samples between least and greatest, enlarged by the rounding of edges.
    const V last = hn::Set(d, kSide_px - 1), beside = hn::Set(d, sample_x(0) - kEdge_px);
    const auto pixel = [&](V at) { return hn::ConvertTo(di, hn::Min(hn::Max(at, zero), last)); };
    const auto flat = hn::RebindMask(di, hn::Eq(area, zero));
    hn::Store(pixel(hn::Add(min_x, beside)), di, s.x0.data() + k);
    hn::Store(hn::IfThenElse(flat, hn::Set(di, -1), pixel(hn::Sub(max_x, beside))), di, s.x1.data() + k);
    hn::Store(pixel(hn::Add(min_y, beside)), di, s.y0.data() + k);
    hn::Store(pixel(hn::Sub(max_y, beside)), di, s.y1.data() + k);
    hn::Store(hn::Add(number, hn::Set(di, static_cast<std::int32_t>(mesh.first_id))), di,
              reinterpret_cast<std::int32_t*>(s.id.data()) + k);
    if (mesh.coplanar_groups)
        for (std::size_t i = k; i < k + hn::Lanes(d); ++i)
            s.id[i] = mesh.first_id + mesh.coplanar_groups[numbers[i]];
}

}  // namespace HWY_NAMESPACE
}  // namespace hilcam
HWY_AFTER_NAMESPACE();

#endif
