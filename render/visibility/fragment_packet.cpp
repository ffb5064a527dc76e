#include "render/visibility/fragment_packet.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/visibility/fragment_packet.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hilcam {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, FragmentPacket::kSize>;
using Ints = hn::RebindToSigned<Floats>;
using V = hn::Vec<Floats>;
using I = hn::Vec<Ints>;

HWY_INLINE V number(float value) { return hn::Set(Floats(), value); }

struct Vector {
    V x, y, z;
};
HWY_INLINE Vector minus(const Vector& a, const Vector& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Vector plus(const Vector& a, const Vector& b) {
    return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Vector times(V s, const Vector& a) { return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)}; }
HWY_INLINE V dotted(const Vector& a, const Vector& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Vector crossed(const Vector& a, const Vector& b) {
    return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
            hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
HWY_INLINE Vector turned(const Mat3f& m, const Vector& a) {
    const auto row = [&](Vec3f r) {
        return hn::Add(hn::Add(hn::Mul(number(r.x), a.x), hn::Mul(number(r.y), a.y)),
                       hn::Mul(number(r.z), a.z));
    };
    return {row(m.x), row(m.y), row(m.z)};
}
// Zero where it has no length, or one beyond single precision.
HWY_INLINE Vector unit(const Vector& a) {
    const V squared = dotted(a, a);
    const auto good = hn::And(hn::Gt(squared, number(1e-30f)), hn::Lt(squared, number(1e30f)));
    return times(hn::IfThenElseZero(good, hn::Div(number(1), hn::Sqrt(squared))), a);
}
template <class Mask>
HWY_INLINE Vector chosen(Mask mask, const Vector& yes, const Vector& no) {
    return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
            hn::IfThenElse(mask, yes.z, no.z)};
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

// unpack_normal() (surface.h).
HWY_INLINE Vector unpacked(I packed) {
    const Floats d;
    const V scale = number(1.0f / 32767.0f);
    V x = hn::Mul(hn::ConvertTo(d, hn::ShiftRight<16>(hn::ShiftLeft<16>(packed))), scale);
    V y = hn::Mul(hn::ConvertTo(d, hn::ShiftRight<16>(packed)), scale);
    const V z = hn::Sub(hn::Sub(number(1), hn::Abs(x)), hn::Abs(y));
    const V t = hn::Max(hn::Neg(z), number(0));
    x = hn::Add(x, hn::CopySign(t, hn::Neg(x)));
    y = hn::Add(y, hn::CopySign(t, hn::Neg(y)));
    return unit({x, y, z});
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

        // Moeller & Trumbore (J. Graphics Tools 2(1), 1997), kept to the triangle: a sample's place may lie
        // beside it by a rounding, and a triangle seen from its edge has no place of its own.
        const Vector e1 = minus(at[1], at[0]), e2 = minus(at[2], at[0]), from_corner = minus(origin, at[0]);
        const Vector across = crossed(dir, e2), along = crossed(from_corner, e1);
        const V inverse = hn::Div(number(1), dotted(e1, across));
        V u = hn::Mul(dotted(from_corner, across), inverse), v = hn::Mul(dotted(dir, along), inverse);
        const auto placed = hn::And(hn::IsFinite(u), hn::IsFinite(v));
        const V third = number(1.0f / 3);
        u = hn::Min(hn::Max(hn::IfThenElse(placed, u, third), number(0)), number(1));
        v = hn::Min(hn::Max(hn::IfThenElse(placed, v, third), number(0)), number(1));
        const V over = hn::Max(hn::Add(u, v), number(1));
        u = hn::Div(u, over), v = hn::Div(v, over);
        const Vector meets = minus(plus(times(u, e1), times(v, e2)), from_corner);
        hn::Store(hn::Div(dotted(meets, dir), dotted(dir, dir)), d, p.distance.data() + k);
        hn::Store(u, d, p.u.data() + k), hn::Store(v, d, p.v.data() + k);

        // The normals, and the viewer's side of them.
        const Vector raw = crossed(e1, e2);
        store(raw, p.body_normal, k);
        const Vector geometric_body = unit(raw);
        const V w = hn::Sub(hn::Sub(number(1), u), v);
        const Vector smooth = plus(plus(times(w, unpacked(normals[0])), times(u, unpacked(normals[1]))),
                                   times(v, unpacked(normals[2])));
        const auto flat = hn::Or(hn::RebindMask(d, hn::Ne(hn::ShiftRight<16>(kind), hn::Zero(di))),
                                 hn::Le(dotted(smooth, smooth), number(1e-6f)));
        const Vector body = chosen(flat, geometric_body, unit(smooth));
        const Vector view = times(number(-1), unit(world_dir));
        Vector geometric = turned(mesh.world_from_body, geometric_body),
               normal = turned(mesh.world_from_body, body);
        const auto back = hn::Lt(dotted(geometric, view), number(0));
        geometric = chosen(back, times(number(-1), geometric), geometric);
        normal = chosen(hn::Lt(dotted(normal, geometric), number(0)), times(number(-1), normal), normal);
        // A smoothed normal that leans away from the viewer would make the surface vanish.
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

void find_lies(const FragmentMesh& mesh, FragmentPacket& packet) { HWY_DYNAMIC_DISPATCH(lies)(mesh, packet); }

}  // namespace hilcam
#endif
