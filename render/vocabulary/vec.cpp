#include "render/vocabulary/vec.h"

namespace hilcam {

Quat to_quat(const Mat3d& m) {
    // The largest of the four squared components is at least 1/4, so its root never loses precision.
    const double trace = m.x.x + m.y.y + m.z.z;
    const std::array<double, 4> four_squares = {1 + trace, 1 + 2 * m.x.x - trace, 1 + 2 * m.y.y - trace,
                                                1 + 2 * m.z.z - trace};
    std::size_t largest = 0;
    for (std::size_t i = 1; i < 4; ++i)
        if (four_squares[i] > four_squares[largest]) largest = i;
    const double root = std::sqrt(four_squares[largest]);
    const double half = 0.5 / root;
    Quat q;
    if (largest == 0)
        q = {0.5 * root, (m.z.y - m.y.z) * half, (m.x.z - m.z.x) * half, (m.y.x - m.x.y) * half};
    if (largest == 1)
        q = {(m.z.y - m.y.z) * half, 0.5 * root, (m.x.y + m.y.x) * half, (m.x.z + m.z.x) * half};
    if (largest == 2)
        q = {(m.x.z - m.z.x) * half, (m.x.y + m.y.x) * half, 0.5 * root, (m.y.z + m.z.y) * half};
    if (largest == 3)
        q = {(m.y.x - m.x.y) * half, (m.x.z + m.z.x) * half, (m.y.z + m.z.y) * half, 0.5 * root};
    return normalized(q.w < 0 ? Quat{-q.w, -q.x, -q.y, -q.z} : q);
}

Quat from_rotation_vector(Vec3d v) {
    const double angle = length(v);
    // sin(a/2)/a by its series where the quotient would lose digits; the next term is below 1e-17.
    const double scale = angle > 1e-4 ? std::sin(0.5 * angle) / angle : 0.5 - angle * angle / 48.0;
    return {std::cos(0.5 * angle), scale * v.x, scale * v.y, scale * v.z};
}

Quat slerp(Quat a, Quat b, double u) {
    double cosine = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
    if (cosine < 0) {
        b = {-b.w, -b.x, -b.y, -b.z};
        cosine = -cosine;
    }
    double wa = 1 - u;
    double wb = u;
    // Closer than 1e-4 rad the chord is the arc to 1e-9 of its length, and sin(angle) would divide badly.
    if (cosine < 1 - 5e-9) {
        const double angle = std::acos(cosine);
        wa = std::sin((1 - u) * angle) / std::sin(angle);
        wb = std::sin(u * angle) / std::sin(angle);
    }
    return normalized(
        Quat{wa * a.w + wb * b.w, wa * a.x + wb * b.x, wa * a.y + wb * b.y, wa * a.z + wb * b.z});
}

}  // namespace hilcam
