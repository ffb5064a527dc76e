#include "render/visibility/rolling_raster.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/visibility/rolling_raster.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "render/visibility/triangle_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hilcam {
namespace HWY_NAMESPACE {

HWY_INLINE V value(float v) { return hn::Set(Floats(), v); }

// A coordinate as a function of the instant: a + u (b + u c).
struct Track {
    V a, b, c;
    V at(V u) const { return times_plus(u, times_plus(u, c, b), a); }
};
HWY_INLINE Track track_of(const RollingProjection& p, Vec3f Mat3f::*row, float Vec3f::*axis, V x, V y, V z) {
    const auto of = [&](std::size_t i) {
        const Vec3f& r = p.axes[i].*row;
        return hn::Add(times_plus(value(r.z), z, times_plus(value(r.y), y, hn::Mul(value(r.x), x))),
                       value(p.origin_m[i].*axis));
    };
    return {of(0), of(1), of(2)};
}

// The paths of vertices across the screen while its rows are read.
struct Ways {
    const RollingProjection& p;
    const ScreenLens* lens;
    Track x, y, z;

    // Finds their ideal places.
    HWY_INLINE void place(V u, V& at_x, V& at_y) const {
        const V scale = hn::Div(value(p.focal_px), z.at(u));
        at_x = times_plus(x.at(u), scale, value(p.center_x)),
        at_y = times_plus(y.at(u), scale, value(p.center_y));
    }
    // Returns the instant of the row in which they are at an instant.
    HWY_INLINE V row(V u) const {
        V at_x, at_y;
        place(u, at_x, at_y);
        if (lens) distort(*lens, at_x, at_y);
        const V half = value(0.5f * p.height_px);
        const V out = hn::Mul(hn::Sub(at_y, half), value(2 / p.height_px));
        return hn::Min(hn::Max(out, value(-1)), value(1));
    }
    // Returns the instant that equals that of its row: two steps, and the secant of both. A vertex that moves
    // by a quarter of a row per row is then right to about 1e-4 of its whole path.
    HWY_INLINE V instant() const {
        const V first = row(hn::Zero(Floats())), second = row(first), third = row(second);
        const V change = hn::Sub(hn::Sub(third, second), hn::Sub(second, first));
        const V step = hn::Div(hn::Mul(hn::Sub(third, second), hn::Sub(second, first)), change);
        const auto usable = hn::And(hn::Gt(hn::Abs(change), value(1e-9f)), hn::Lt(hn::Abs(step), value(1)));
        return row(hn::IfThenElse(usable, hn::Sub(second, step), third));
    }
    // Returns the largest motion per row.
    HWY_INLINE V speed() const {
        V x_of[3], y_of[3];
        for (int i = 0; i < 3; ++i) place(value(static_cast<float>(i - 1)), x_of[i], y_of[i]);
        const auto greatest = [](const V* of) {
            return hn::Max(hn::Abs(hn::Sub(of[1], of[0])), hn::Abs(hn::Sub(of[2], of[1])));
        };
        return hn::Mul(hn::Max(greatest(x_of), greatest(y_of)), value(2 / p.height_px));
    }
};

float roll(std::span<const Vec3f> vertices_m, const RollingProjection& p, const ScreenLens* lens,
           ScreenVertex* out) {
    // Rounded up, because depth must not be less than a tile's own.
    constexpr float kNearer = 1 + 1e-5f;
    V fastest = hn::Zero(Floats());
    std::size_t left = vertices_m.size();
    for_vertices(vertices_m, out, [&](V x, V y, V z, float* to) {
        const Ways ways{p, lens, track_of(p, &Mat3f::x, &Vec3f::x, x, y, z),
                        track_of(p, &Mat3f::y, &Vec3f::y, x, y, z),
                        track_of(p, &Mat3f::z, &Vec3f::z, x, y, z)};
        const V nearest = hn::Min(ways.z.at(value(0)), hn::Min(ways.z.at(value(-1)), ways.z.at(value(1))));
        const V u = ways.instant(), speed = ways.speed();
        Projected at;
        ways.place(u, at.x, at.y);
        at.z_m = nearest;
        at.depth = hn::Sub(hn::Div(value(p.depth_origin_m * kNearer), nearest), value(1));
        write_vertices(at, speed, to);
        const auto inside = [](V place, V size) {
            return hn::And(hn::Ge(place, hn::Zero(Floats())), hn::Le(place, size));
        };
        const auto in_rows = hn::Lt(hn::Abs(u), value(1));
        const auto counted = hn::And(hn::FirstN(Floats(), left), hn::Gt(nearest, hn::Zero(Floats())));
        const auto seen = hn::And(hn::And(inside(at.x, value(p.width_px)), in_rows), counted);
        fastest = hn::Max(fastest, hn::IfThenElseZero(seen, speed));
        left -= std::min(left, hn::Lanes(Floats()));
    });
    return hn::GetLane(hn::MaxOfLanes(Floats(), fastest));
}

// An edge between two vertices that appear at instants dt apart deviates from the line between their places
// by at most a quarter of dt times the difference of their speeds, so by half of dt times the larger speed. A
// lens may increase that by half.
constexpr float kBowed = 0.75f;

std::size_t tiles_of_rolling(const ScreenVertex* vertices, std::span<const TriangleCorners> triangles,
                             std::uint32_t first, int width_px, int height_px, float margin_px,
                             const ScreenLens* lens, TileRange* ranges) {
    const Floats d;
    const auto margin_of = [&](std::size_t t, const Corners& c) {
        HWY_ALIGN float speed[kTrianglesAtOnce];
        for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
            const TriangleCorners& corners = triangles[std::min(t + k, triangles.size() - 1)];
            speed[k] = std::max(
                {vertices[corners[0]].speed, vertices[corners[1]].speed, vertices[corners[2]].speed});
        }
        const V rows = hn::Min(hn::Sub(most(c.y), least(c.y)), value(static_cast<float>(height_px)));
        return times_plus(hn::Mul(hn::Load(d, speed), value(kBowed)), rows, value(margin_px));
    };
    return lens ? tiles_with<true>(vertices, triangles, first, width_px, height_px, lens, margin_of, ranges)
                : tiles_with<false>(vertices, triangles, first, width_px, height_px, lens, margin_of, ranges);
}

void set_up_rolling(const RollingMesh& of, const std::array<std::uint32_t, kTrianglesAtOnce>& numbers,
                    std::size_t count, int tile_x_px, int tile_y_px, const TileLens* lens, TriangleSetup& s) {
    const Floats d;
    s.count = count;
    for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
        TwoInstants rows;
        Corners c;
        for (std::size_t i = 0; i < 3; ++i) {
            HWY_ALIGN float x[kTrianglesAtOnce], y[kTrianglesAtOnce], z[kTrianglesAtOnce];
            for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
                const Vec3f& v = of.vertices_m[of.mesh.triangles[numbers[k + lane]][i]];
                x[lane] = v.x, y[lane] = v.y, z[lane] = v.z;
            }
            for (const bool is_upper : {true, false}) {
                const Projected at =
                    projected(is_upper ? of.upper : of.lower, hn::Load(d, x), hn::Load(d, y), hn::Load(d, z));
                Corners& out = is_upper ? rows.upper : rows.lower;
                out.x[i] = at.x, out.y[i] = at.y, out.depth[i] = at.depth;
            }
        }
        move_into_tile(tile_x_px, tile_y_px, lens, rows.upper);
        move_into_tile(tile_x_px, tile_y_px, lens, rows.lower);
        const auto halfway = [](V a, V b) { return hn::Mul(value(0.5f), hn::Add(a, b)); };
        for (std::size_t i = 0; i < 3; ++i) {
            c.x[i] = halfway(rows.upper.x[i], rows.lower.x[i]),
            c.y[i] = halfway(rows.upper.y[i], rows.lower.y[i]);
            c.depth[i] = halfway(rows.upper.depth[i], rows.lower.depth[i]);
        }
        set_up_lanes(of.mesh, numbers.data(), c, rows, k, s);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace hilcam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hilcam {

HWY_EXPORT(roll);
HWY_EXPORT(tiles_of_rolling);
HWY_EXPORT(set_up_rolling);

float roll_vertices(std::span<const Vec3f> vertices_m, const RollingProjection& projection,
                    const ScreenLens* lens, ScreenVertex* out) {
    return HWY_DYNAMIC_DISPATCH(roll)(vertices_m, projection, lens, out);
}
std::size_t find_rolling_tiles(const ScreenVertex* vertices, std::span<const TriangleCorners> triangles,
                               std::uint32_t first, int width_px, int height_px, float margin_px,
                               const ScreenLens* lens, TileRange* ranges) {
    if (triangles.empty()) return 0;
    return HWY_DYNAMIC_DISPATCH(tiles_of_rolling)(vertices, triangles, first, width_px, height_px, margin_px,
                                                  lens, ranges);
}
void set_up_rolling_triangles(const RollingMesh& mesh,
                              const std::array<std::uint32_t, kTrianglesAtOnce>& numbers, std::size_t count,
                              int tile_x_px, int tile_y_px, const TileLens* lens, TriangleSetup& setup) {
    HWY_DYNAMIC_DISPATCH(set_up_rolling)(mesh, numbers, count, tile_x_px, tile_y_px, lens, setup);
}

}  // namespace hilcam
#endif
