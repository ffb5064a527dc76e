#include "render/ground_shading/ground_packet.h"

#include <algorithm>
#include <cstring>

#include "render/vocabulary/units.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/ground_shading/ground_packet.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "render/visibility/lane_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hilcam {
namespace HWY_NAMESPACE {

HWY_INLINE Vector vector(Vec3f v) { return {number(v.x), number(v.y), number(v.z)}; }
HWY_INLINE Vector load(const GroundPacket::Vectors& from, std::size_t k) {
    const Floats d;
    return {hn::Load(d, from.x.data() + k), hn::Load(d, from.y.data() + k), hn::Load(d, from.z.data() + k)};
}
HWY_INLINE V load(const GroundPacket::Floats& from, std::size_t k) {
    return hn::Load(Floats(), from.data() + k);
}
HWY_INLINE void store(V value, GroundPacket::Floats& to, std::size_t k) {
    hn::Store(value, Floats(), to.data() + k);
}

// The natural logarithm of a normal positive number, as in sensor/noise.cpp: error below 2e-7.
HWY_INLINE V logarithm(V x) {
    const Floats d;
    const Ints di;
    const I bits = hn::BitCast(di, x);
    const I exponent = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(di, 0x3F3504F3)));
    const V m = hn::BitCast(d, hn::Sub(bits, hn::ShiftLeft<23>(exponent)));
    const V s = hn::Div(hn::Sub(m, number(1)), hn::Add(m, number(1))), s2 = hn::Mul(s, s);
    V series = number(1.0f / 9);
    for (const float term : {1.0f / 7, 1.0f / 5, 1.0f / 3, 1.0f})
        series = hn::Add(number(term), hn::Mul(s2, series));
    return hn::Add(hn::Mul(hn::ConvertTo(d, exponent), number(0.69314718f)),
                   hn::Mul(hn::Mul(number(2), s), series));
}

// Four packed normals around each place, neighbours in pairs, and its position between them.
struct alignas(64) Neighbours {
    std::uint32_t low[2 * GroundPacket::kSize], high[2 * GroundPacket::kSize];
    float x[GroundPacket::kSize], y[GroundPacket::kSize];

    void take(std::size_t i, const std::uint32_t* from, std::size_t side) {
        std::memcpy(low + 2 * i, from, 2 * sizeof *from);
        std::memcpy(high + 2 * i, from + side, 2 * sizeof *from);
    }
    void take(std::size_t i, const GroundNormals::Grid& grid, int side, float px, float py) {
        const int column = std::min(static_cast<int>(px), side - 2),
                  row = std::min(static_cast<int>(py), side - 2);
        x[i] = px - static_cast<float>(column), y[i] = py - static_cast<float>(row);
        take(i, grid.data() + row * side + column, static_cast<std::size_t>(side));
    }
    HWY_INLINE Vector mean(std::size_t k) const {
        const Floats d;
        const V dx = hn::Load(d, x + k), dy = hn::Load(d, y + k);
        const auto between = [&](const std::uint32_t* row) {
            I first, second;
            hn::LoadInterleaved2(Ints(), reinterpret_cast<const std::int32_t*>(row) + 2 * k, first, second);
            return plus(times(hn::Sub(number(1), dx), unpacked_long(first)),
                        times(dx, unpacked_long(second)));
        };
        return plus(times(hn::Sub(number(1), dy), between(low)), times(dy, between(high)));
    }
};
struct alignas(64) Lookups {
    Neighbours own, above;             // normals of a tile's level, and of the next coarser one
    float share[GroundPacket::kSize];  // weight of `above`
};

// Finds each place in the grids of normals (GroundNormals::find). Triangles without grids use their corners'
// normals.
void look_up(const ObjectSurfaces& surfaces, GroundPacket& p, Lookups& at) {
    constexpr int kQuads = GroundNormals::kQuads, kTexels = GroundNormals::kTexels;
    const GroundNormals* const normals = surfaces.ground_normals.get();
    const SunVisibility* const known =
        surfaces.sun_visibility.empty() ? nullptr : surfaces.sun_visibility.data();
    std::uint32_t first = 1, end = 0;  // triangles of the tile below
    const GroundNormals::Tile* tile = nullptr;
    for (std::size_t i = 0; i < GroundPacket::kSize; ++i) {
        const std::uint32_t triangle = p.triangle[i];
        p.sun[i] = known ? known[triangle] : SunVisibility::kAsk;
        if (normals && !(triangle >= first && triangle < end)) {
            const std::uint32_t number = triangle / normals->triangles_per_tile;
            first = number * normals->triangles_per_tile, end = first + normals->triangles_per_tile;
            tile = number < normals->tiles.size() ? &normals->tiles[number] : nullptr;
        }
        const std::uint32_t in_tile = triangle - first;
        at.share[i] = 0;
        if (!tile || in_tile >= 2 * kQuads * kQuads) {
            // Barycentric weights as a bilinear mean: (1 - v) ((1 - x) n0 + x n1) + v n2.
            const auto& n = surfaces.triangles[triangle].corner_normals;
            const std::uint32_t corners[4] = {n[0], n[1], n[2], n[2]};
            at.own.take(i, corners, 2);
            at.own.x[i] = p.v[i] < 1 ? p.u[i] / (1 - p.v[i]) : 0.0f, at.own.y[i] = p.v[i];
            continue;
        }
        const std::uint32_t x = in_tile / 2 % kQuads, y = in_tile / 2 / kQuads;
        const bool second = in_tile % 2 == 1;
        const float dx = second ? 1 - p.v[i] : p.u[i], dy = second ? p.u[i] + p.v[i] : p.v[i];
        const std::uint8_t* const share = &tile->share[y * (kQuads + 1) + x];
        const float low = (1 - dx) * share[0] + dx * share[1],
                    high = (1 - dx) * share[kQuads + 1] + dx * share[kQuads + 2];
        at.share[i] = ((1 - dy) * low + dy * high) * (1.0f / 255);
        const float px = (static_cast<float>(x) + dx) * kTexels, py = (static_cast<float>(y) + dy) * kTexels;
        at.own.take(i, *tile->own, GroundNormals::kSide, px, py);
        if (at.share[i] > 0) at.above.take(i, *tile->above, GroundNormals::kHalfSide, 0.5f * px, 0.5f * py);
    }
}

// Positions and colours of corners, gathered.
struct alignas(64) Corners {
    float position[3][3][GroundPacket::kSize];  // by corner and axis
    float color[3][3][GroundPacket::kSize];     // by corner and channel
};
void gather(const GroundInFrame& frame, const GroundPacket& p, Corners& out) {
    const bool colored = !frame.surfaces->corner_colors.empty();
    for (std::size_t i = 0; i < GroundPacket::kSize; ++i) {
        const std::uint32_t triangle = p.triangle[i];
        const auto& corners = frame.mesh.triangles[triangle];
        for (std::size_t c = 0; c < 3; ++c) {
            const Vec3f& at = frame.mesh.vertices_m[corners[c]];
            out.position[c][0][i] = at.x, out.position[c][1][i] = at.y, out.position[c][2][i] = at.z;
        }
        if (!colored) continue;
        const auto& colors = frame.surfaces->corner_colors[triangle];
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t channel = 0; channel < 3; ++channel)
                out.color[c][channel][i] = static_cast<float>(colors[c][channel]);
    }
}

HWY_INLINE void meet(const Vector (&at)[3], const Vector& camera, const Vector& dir, std::size_t k,
                     GroundPacket& p) {
    const Meeting m = meeting_of(at, camera, dir);
    store(m.u, p.u, k), store(m.v, p.v, k);
    const Vector raw = crossed(m.e1, m.e2);
    const auto back = hn::Gt(dotted(raw, dir), number(0));
    const Vector seen = chosen(back, times(number(-1), raw), raw);
    store(seen.x, p.geometric.x, k), store(seen.y, p.geometric.y, k), store(seen.z, p.geometric.z, k);
}

HWY_INLINE void find_cosines(const GroundInFrame& frame, const Lookups& lookups, std::size_t k,
                             GroundPacket& p) {
    const Floats d;
    const V above = hn::Load(d, lookups.share + k);
    Vector sum = lookups.own.mean(k);
    // Most of a picture is at one level.
    if (!hn::AllTrue(d, hn::Eq(above, number(0))))
        sum = plus(times(hn::Sub(number(1), above), sum), times(above, lookups.above.mean(k)));
    const Vector geometric = load(p.geometric, k), view = times(number(-1), unit(load(p.dir, k)));
    Vector normal = unit(sum);
    normal = chosen(hn::Lt(dotted(normal, geometric), number(0)), times(number(-1), normal), normal);
    // A smoothed normal that faces away from the viewer would make the surface vanish.
    const auto none =
        hn::Or(hn::Le(dotted(sum, sum), number(1e-6f)), hn::Le(dotted(normal, view), number(1e-4f)));
    if (!hn::AllFalse(d, none)) normal = chosen(none, unit(geometric), normal);
    const Vector sun = vector(frame.sun_dir);
    const V ni = dotted(normal, sun);
    const auto lit = hn::And(hn::Gt(ni, number(0)), hn::Gt(dotted(geometric, sun), number(0)));
    store(hn::Max(dotted(normal, view), number(1e-4f)), p.no, k);
    store(hn::IfThenElseZero(lit, ni), p.ni, k);
    store(dotted(view, sun), p.io, k);
}

void find(const GroundInFrame& frame, GroundPacket& p) {
    const Floats d;
    const std::size_t lanes = hn::Lanes(d);
    Corners corners;
    gather(frame, p, corners);
    const Vector camera = vector(frame.camera_m);
    const V step = number(1 / kColorSteps);
    for (std::size_t k = 0; k < GroundPacket::kSize; k += lanes) {
        Vector at[3];
        for (std::size_t c = 0; c < 3; ++c)
            at[c] = {hn::Load(d, corners.position[c][0] + k), hn::Load(d, corners.position[c][1] + k),
                     hn::Load(d, corners.position[c][2] + k)};
        meet(at, camera, load(p.dir, k), k, p);
        const V u = load(p.u, k), v = load(p.v, k), w = hn::Sub(hn::Sub(number(1), u), v);
        for (std::size_t channel = 0; channel < 3; ++channel) {
            V color = number(1);
            if (!frame.surfaces->corner_colors.empty())
                color = hn::Mul(hn::Add(hn::Add(hn::Mul(w, hn::Load(d, corners.color[0][channel] + k)),
                                                hn::Mul(u, hn::Load(d, corners.color[1][channel] + k))),
                                        hn::Mul(v, hn::Load(d, corners.color[2][channel] + k))),
                                step);
            store(color, p.color[channel], k);
        }
    }
    Lookups lookups{};  // entries that no place needs are read, too
    look_up(*frame.surfaces, p, lookups);
    for (std::size_t k = 0; k < GroundPacket::kSize; k += lanes) find_cosines(frame, lookups, k, p);
}

// The lanes' version of hapke_geometry() (hapke.h), for ground without slopes.
void hapke(const HapkeParameters& h, const GroundPacket& p, HapkePacket& out) {
    const Floats d;
    const std::size_t lanes = hn::Lanes(d);
    const float b2 = h.b * h.b;
    for (std::size_t k = 0; k < GroundPacket::kSize; k += lanes) {
        const V cos_g = hn::Min(hn::Max(load(p.io, k), number(-1)), number(1));
        const auto lobe = [&](float sign) {
            const V x = hn::Add(hn::Add(number(1), hn::Mul(number(sign * 2 * h.b), cos_g)), number(b2));
            return hn::Div(number(1 - b2), hn::Mul(x, hn::Sqrt(x)));
        };
        const V hg =
            hn::Add(hn::Mul(number(0.5f * (1 + h.c)), lobe(-1)), hn::Mul(number(0.5f * (1 - h.c)), lobe(1)));
        const V tan_half_g =
            hn::Sqrt(hn::Div(hn::Sub(number(1), cos_g), hn::Max(number(1e-12f), hn::Add(number(1), cos_g))));
        V surge = number(0);
        if (h.surge_amplitude > 0)
            surge = hn::Div(number(h.surge_amplitude * h.surge_width),
                            hn::Add(number(h.surge_width), tan_half_g));
        store(hn::Mul(hn::Add(number(1), surge), hg), out.phase, k);
        const V mu0 = load(p.ni, k), mu = load(p.no, k);
        const V ni = hn::Max(mu0, number(1e-6f));
        store(hn::Div(mu0, hn::Mul(hn::Mul(ni, number(4 * kPiF)), hn::Add(mu0, mu))), out.factor, k);
        const auto log_of = [&](V x) { return logarithm(hn::Div(hn::Add(number(1), x), x)); };
        store(log_of(ni), out.log0, k), store(log_of(mu), out.log1, k);
    }
}

// The lanes' version of hapke() and hapke_h() (hapke.h).
void reflect(const HapkePacket& hapke, const GroundPacket& p, float scale,
             const GroundPacket::Floats& albedos, GroundPacket::Floats& out) {
    const Floats d;
    const std::size_t lanes = hn::Lanes(d);
    const V one = number(1), half = number(0.5f);
    for (std::size_t k = 0; k < GroundPacket::kSize; k += lanes) {
        const V albedo = load(albedos, k), mu0 = load(p.ni, k);
        // H = d / (d - w x (n + (d - 2 n x) / 2 ln((1 + x) / x))) with r0 = n / d: one division for both.
        const V gamma = hn::Sqrt(hn::Max(number(0), hn::Sub(one, albedo)));
        const V n = hn::Sub(one, gamma), d_of = hn::Add(one, gamma);
        const auto below = [&](V x, V log) {
            const V inner = hn::Mul(hn::Mul(half, hn::Sub(d_of, hn::Mul(hn::Mul(number(2), n), x))), log);
            return hn::Sub(d_of, hn::Mul(hn::Mul(albedo, x), hn::Add(n, inner)));
        };
        const V both = hn::Mul(below(mu0, load(hapke.log0, k)), below(load(p.no, k), load(hapke.log1, k)));
        const V sum = hn::Sub(hn::Add(load(hapke.phase, k), hn::Div(hn::Mul(d_of, d_of), both)), one);
        const V f = hn::Mul(hn::Mul(albedo, load(hapke.factor, k)), sum);
        store(hn::Mul(hn::Mul(number(scale), mu0), f), out, k);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace hilcam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hilcam {

HWY_EXPORT(find);
HWY_EXPORT(hapke);
HWY_EXPORT(reflect);

void find_ground(const GroundInFrame& frame, GroundPacket& packet) {
    HWY_DYNAMIC_DISPATCH(find)(frame, packet);
}
void find_hapke(const HapkeParameters& parameters, const GroundPacket& packet, HapkePacket& out) {
    HWY_DYNAMIC_DISPATCH(hapke)(parameters, packet, out);
}
void reflect_hapke(const HapkePacket& hapke, const GroundPacket& packet, float scale,
                   const GroundPacket::Floats& albedo, GroundPacket::Floats& out) {
    HWY_DYNAMIC_DISPATCH(reflect)(hapke, packet, scale, albedo, out);
}

}  // namespace hilcam
#endif
