#include "render/visibility/fragment_packet.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/visibility/fragment_packet.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "render/visibility/lane_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hilcam {
namespace HWY_NAMESPACE {

HWY_INLINE Vector turned(const Mat3f& m, const Vector& a) {
    const auto row = [&](Vec3f r) {
        return hn::Add(hn::Add(hn::Mul(number(r.x), a.x), hn::Mul(number(r.y), a.y)),
                       hn::Mul(number(r.z), a.z));
    };
    return {row(m.x), row(m.y), row(m.z)};
}
HWY_INLINE Vector load(const FragmentPacket::Vectors& from, std::size_t k) {
    const Floats d;
    return {hn::Load(d, from.x.data() + k), hn::Load(d, from.y.data() + k), hn::Load(d, from.z.data() + k)};
}
HWY_INLINE void store(const Vector& a, FragmentPacket::Vectors& to, std::size_t k) {
    const Floats d;
    hn::Store(a.x, d, to.x.data() + k), hn::Store(a.y, d, to.y.data() + k),
        hn::Store(a.z, d, to.z.data() + k);
}

// The lanes' version of unpack_normal() (packed_normal.h).
HWY_INLINE Vector unpacked(I packed) { return unit(unpacked_long(packed)); }

// Returns the largest squared distance between two of three.
HWY_INLINE V turn_of(const Vector (&normals)[3]) {
    const auto squared = [&](std::size_t i, std::size_t j) {
        const Vector way = minus(normals[i], normals[j]);
        return dotted(way, way);
    };
    return hn::Max(hn::Max(squared(0, 1), squared(1, 2)), squared(2, 0));
}

// Returns the distance along a ray at which it meets a plane, given one that is right but for rounding. The
// triangle's barycentric coordinates are rounded: on a triangle a hundred times longer than wide they place a
// point 1e-5 of its distance off the plane, and a point below the plane is in the triangle's own shadow.
// A larger correction means that the ray passes beside the triangle; the distance then stays.
HWY_INLINE V on_plane(V distance, const Vector& from_corner, const Vector& dir, const Vector& normal) {
    constexpr float kMost = 0x1p-14f;  // relative: six times that
    const V above = dotted(plus(from_corner, times(distance, dir)), normal);
    const V off = hn::Div(above, dotted(dir, normal)), most = hn::Mul(number(kMost), hn::Abs(distance));
    const auto is_rounding = hn::Le(hn::Abs(off), most);  // false for NaN
    return hn::Sub(distance, hn::IfThenElseZero(is_rounding, off));
}

void lies(const FragmentMesh& mesh, FragmentPacket& p) {
    const Floats d;
    const Ints di;
    const std::size_t lanes = hn::Lanes(d);
    HWY_ALIGN float corner[3][3 * FragmentPacket::kSize];
    HWY_ALIGN PackedTriangle surface[FragmentPacket::kSize];
    for (std::size_t k = 0; k < p.count; k += lanes) {
        for (std::size_t i = 0; i < lanes; ++i) {
            const std::uint32_t triangle = p.triangle[k + i];
            surface[i] = mesh.surfaces[triangle];
            for (std::size_t j = 0; j < 3; ++j) {
                const Vec3f& at = mesh.vertices_m[mesh.corners[triangle][j]];
                corner[j][3 * i] = at.x, corner[j][3 * i + 1] = at.y, corner[j][3 * i + 2] = at.z;
            }
        }
        Vector at[3];
        for (std::size_t j = 0; j < 3; ++j) hn::LoadInterleaved3(d, corner[j], at[j].x, at[j].y, at[j].z);
        I normals[3], kind;
        hn::LoadInterleaved4(di, reinterpret_cast<const std::int32_t*>(surface), normals[0], normals[1],
                             normals[2], kind);
        const Mat3f body_from_world = transposed(mesh.world_from_body);
        const Vector world_dir = load(p.dir, k);
        const Vector dir = turned(body_from_world, world_dir),
                     origin = turned(body_from_world, load(p.origin, k));

        const Meeting m = meeting_of(at, origin, dir);
        const V u = m.u, v = m.v;
        // A triangle that represents a group is hit anywhere in its plane.
        const auto is_group = hn::RebindMask(d, hn::Ne(hn::ShiftRight<24>(kind), hn::Zero(di)));
        const V along = hn::IfThenElse(is_group, m.plane_u, u),
                across = hn::IfThenElse(is_group, m.plane_v, v);
        const Vector meets = minus(plus(times(along, m.e1), times(across, m.e2)), m.from_corner);
        const Vector raw = crossed(m.e1, m.e2);
        const Vector geometric_body = unit(raw);
        const V distance = hn::Div(dotted(meets, dir), dotted(dir, dir));
        hn::Store(on_plane(distance, m.from_corner, dir, geometric_body), d, p.distance.data() + k);
        hn::Store(u, d, p.u.data() + k), hn::Store(v, d, p.v.data() + k);

        // The normals, turned to the viewer's side.
        store(raw, p.body_normal, k);
        const Vector third = minus(m.e1, m.e2);
        const V longest = hn::Max(hn::Max(dotted(m.e1, m.e1), dotted(m.e2, m.e2)), dotted(third, third));
        hn::Store(hn::Div(dotted(raw, raw), hn::Max(longest, number(1e-30f))), d, p.height.data() + k);
        const V w = hn::Sub(hn::Sub(number(1), u), v);
        const Vector corners[3] = {unpacked(normals[0]), unpacked(normals[1]), unpacked(normals[2])};
        const Vector smooth = plus(plus(times(w, corners[0]), times(u, corners[1])), times(v, corners[2]));
        const I flags = hn::And(kind, hn::Set(di, 0x00FF0000));
        const auto flat = hn::Or(hn::RebindMask(d, hn::Ne(flags, hn::Zero(di))),
                                 hn::Le(dotted(smooth, smooth), number(1e-6f)));
        hn::Store(hn::IfThenZeroElse(flat, turn_of(corners)), d, p.turn.data() + k);
        const Vector body = chosen(flat, geometric_body, unit(smooth));
        const Vector view = times(number(-1), unit(world_dir));
        Vector geometric = turned(mesh.world_from_body, geometric_body),
               normal = turned(mesh.world_from_body, body);
        const auto back = hn::Lt(dotted(geometric, view), number(0));
        geometric = chosen(back, times(number(-1), geometric), geometric);
        normal = chosen(hn::Lt(dotted(normal, geometric), number(0)), times(number(-1), normal), normal);
        // A smoothed normal that faces away from the viewer would make the surface vanish.
        normal = chosen(hn::Le(dotted(normal, view), number(1e-4f)), geometric, normal);
        store(geometric, p.geometric, k), store(normal, p.normal, k), store(view, p.view_dir, k);
        hn::Store(hn::IfThenElseZero(hn::RebindMask(di, back), hn::Set(di, 1)), di,
                  reinterpret_cast<std::int32_t*>(p.back.data()) + k);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace hilcam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hilcam {

HWY_EXPORT(lies);

void find_surface_frames(const FragmentMesh& mesh, FragmentPacket& packet) {
    HWY_DYNAMIC_DISPATCH(lies)(mesh, packet);
}

}  // namespace hilcam
#endif
