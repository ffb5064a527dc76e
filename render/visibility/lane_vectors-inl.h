// Spatial vectors of sixteen lanes, and intersections of rays and triangles, for code that is compiled for
// several vector widths. Included once per width, like Highway's own headers.

#if defined(HILCAM_LANE_VECTORS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HILCAM_LANE_VECTORS_INL_H
#undef HILCAM_LANE_VECTORS_INL_H
#else
#define HILCAM_LANE_VECTORS_INL_H
#endif

#include <hwy/highway.h>

#include "render/scene/coplanar_groups.h"
#include "render/visibility/sixteen_lanes-inl.h"
#include "render/vocabulary/vec.h"

HWY_BEFORE_NAMESPACE();
namespace hilcam {
namespace HWY_NAMESPACE {

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
// Zero if the vector has no length, or one beyond single precision.
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

// The lanes' version of unpack_long_normal() (packed_normal.h).
HWY_INLINE Vector unpacked_long(I packed) {
    const Floats d;
    const V scale = number(1.0f / 32767.0f);
    V x = hn::Mul(hn::ConvertTo(d, hn::ShiftRight<16>(hn::ShiftLeft<16>(packed))), scale);
    V y = hn::Mul(hn::ConvertTo(d, hn::ShiftRight<16>(packed)), scale);
    const V z = hn::Sub(hn::Sub(number(1), hn::Abs(x)), hn::Abs(y));
    const V t = hn::Max(hn::Neg(z), number(0));
    x = hn::Add(x, hn::CopySign(t, hn::Neg(x)));
    y = hn::Add(y, hn::CopySign(t, hn::Neg(y)));
    return {x, y, z};
}

// Intersections of rays with the planes of triangles.
struct Meeting {
    Vector e1, e2, from_corner;  // edges, and vector from the first corner to the rays' origin
    V u, v;                      // barycentric, clamped to the triangle
    V plane_u, plane_v;          // coordinates in its plane, clamped to kCoplanarReach
};
// Moeller & Trumbore (J. Graphics Tools 2(1), 1997), clamped to the triangle: rounding may put a sample
// beside it, and a triangle that is seen edge-on has no intersection of its own.
HWY_INLINE Meeting meeting_of(const Vector (&corners)[3], const Vector& origin, const Vector& dir) {
    Meeting m;
    m.e1 = minus(corners[1], corners[0]), m.e2 = minus(corners[2], corners[0]);
    m.from_corner = minus(origin, corners[0]);
    const Vector across = crossed(dir, m.e2), along = crossed(m.from_corner, m.e1);
    const V inverse = hn::Div(number(1), dotted(m.e1, across));
    V u = hn::Mul(dotted(m.from_corner, across), inverse), v = hn::Mul(dotted(dir, along), inverse);
    const auto placed = hn::And(hn::IsFinite(u), hn::IsFinite(v));
    const V third = number(1.0f / 3);
    u = hn::IfThenElse(placed, u, third), v = hn::IfThenElse(placed, v, third);
    const V reach = number(kCoplanarReach);
    m.plane_u = hn::Min(hn::Max(u, hn::Neg(reach)), reach);
    m.plane_v = hn::Min(hn::Max(v, hn::Neg(reach)), reach);
    u = hn::Min(hn::Max(u, number(0)), number(1)), v = hn::Min(hn::Max(v, number(0)), number(1));
    const V over = hn::Max(hn::Add(u, v), number(1));
    m.u = hn::Div(u, over), m.v = hn::Div(v, over);
    return m;
}

}  // namespace HWY_NAMESPACE
}  // namespace hilcam
HWY_AFTER_NAMESPACE();

#endif
