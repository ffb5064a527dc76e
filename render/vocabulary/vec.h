#pragma once
// Three-vectors, 3x3 matrices and unit quaternions: the linear algebra that the program needs.

#include <array>
#include <cmath>

namespace hilcam {

template <class T>
struct Vec2 {
    T x{}, y{};
};

template <class T>
struct Vec3 {
    T x{}, y{}, z{};

    friend constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
    friend constexpr Vec3 operator*(T s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
    friend constexpr Vec3 operator*(Vec3 a, T s) { return s * a; }
    friend constexpr Vec3 operator/(Vec3 a, T s) { return {a.x / s, a.y / s, a.z / s}; }
    friend constexpr bool operator==(Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
};

using Vec2f = Vec2<float>;
using Vec2d = Vec2<double>;
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

template <class T>
constexpr T dot(Vec3<T> a, Vec3<T> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
T length(Vec3<T> a) {
    return std::sqrt(dot(a, a));
}
// Returns the angle between two vectors, 0 to pi. Exact for small angles too, where an arc cosine is not.
inline double angle_between_rad(Vec3d a, Vec3d b) { return std::atan2(length(cross(a, b)), dot(a, b)); }
// Returns the unit vector along a. A zero or non-finite vector gives NaN, so callers check input from
// outside. Always inline: a call would cost more than the square root.
template <class T>
[[gnu::always_inline]] inline Vec3<T> normalized(Vec3<T> a) {
    return a / length(a);
}
// The one place where the world's doubles become single precision, after the camera's position was
// subtracted.
inline Vec3f to_float(Vec3d a) {
    return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}
inline Vec3d to_double(Vec3f a) { return {a.x, a.y, a.z}; }
inline bool is_finite(Vec3d a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

template <class T>
struct Mat3 {
    // Rows.
    Vec3<T> x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

    friend constexpr Vec3<T> operator*(const Mat3& m, Vec3<T> v) {
        return {dot(m.x, v), dot(m.y, v), dot(m.z, v)};
    }
    friend constexpr Mat3 operator*(const Mat3& a, const Mat3& b) {
        const Mat3 t = transposed(b);
        return {{dot(a.x, t.x), dot(a.x, t.y), dot(a.x, t.z)},
                {dot(a.y, t.x), dot(a.y, t.y), dot(a.y, t.z)},
                {dot(a.z, t.x), dot(a.z, t.y), dot(a.z, t.z)}};
    }
    friend constexpr Mat3 transposed(const Mat3& m) {
        return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}};
    }
};
using Mat3d = Mat3<double>;
using Mat3f = Mat3<float>;

// Hamilton quaternion, scalar first. A unit quaternion q rotates v as q v q*.
struct Quat {
    double w{1}, x{0}, y{0}, z{0};

    friend constexpr Quat operator*(Quat a, Quat b) {
        return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
    }
    friend constexpr Quat conjugate(Quat q) { return {q.w, -q.x, -q.y, -q.z}; }
};

inline double norm(Quat q) { return std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z); }
inline Quat normalized(Quat q) {
    const double n = norm(q);
    return {q.w / n, q.x / n, q.y / n, q.z / n};
}
// The rotation matrix of a unit quaternion.
inline Mat3d to_matrix(Quat q) {
    return {{1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y - q.w * q.z), 2 * (q.x * q.z + q.w * q.y)},
            {2 * (q.x * q.y + q.w * q.z), 1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z - q.w * q.x)},
            {2 * (q.x * q.z - q.w * q.y), 2 * (q.y * q.z + q.w * q.x), 1 - 2 * (q.x * q.x + q.y * q.y)}};
}
// The unit quaternion (w >= 0) of a rotation matrix. Shepperd, J. Guidance and Control 1(3), 1978.
Quat to_quat(const Mat3d& m);
// Rotation by |v| radians about v (the exponential map); v = 0 gives the identity.
Quat from_rotation_vector(Vec3d v);
// Shortest-arc spherical interpolation; u in [0, 1]. Shoemake, SIGGRAPH 1985.
Quat slerp(Quat a, Quat b, double u);

}  // namespace hilcam
