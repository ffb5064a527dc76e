#pragma once
// The transform of a node of a mesh file: an affine map in single precision, as files have coordinates.

#include <array>
#include <cmath>
#include <cstddef>

#include "render/vocabulary/vec.h"

namespace hilcam {

struct NodeMatrix {
    std::array<std::array<float, 4>, 4> row{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

    static NodeMatrix moved(Vec3f by) {
        NodeMatrix m;
        m.row[0][3] = by.x, m.row[1][3] = by.y, m.row[2][3] = by.z;
        return m;
    }
    static NodeMatrix scaled(Vec3f by) {
        NodeMatrix m;
        m.row[0][0] = by.x, m.row[1][1] = by.y, m.row[2][2] = by.z;
        return m;
    }
    // Returns the rotation by a unit quaternion x, y, z, w.
    static NodeMatrix turned(const std::array<float, 4>& q) {
        const auto [x, y, z, w] = q;
        NodeMatrix m;
        m.row[0] = {1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), 0};
        m.row[1] = {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), 0};
        m.row[2] = {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), 0};
        return m;
    }

    Vec3f place(Vec3f p) const {
        return {along(0, p) + row[0][3], along(1, p) + row[1][3], along(2, p) + row[2][3]};
    }
    float along(std::size_t i, Vec3f p) const { return row[i][0] * p.x + row[i][1] * p.y + row[i][2] * p.z; }
    float determinant() const {
        const auto& [a, b, c, d] = row;
        return a[0] * b[1] * c[2] - a[0] * b[2] * c[1] + a[1] * b[2] * c[0] - a[1] * b[0] * c[2] +
               a[2] * b[0] * c[1] - a[2] * b[1] * c[0];
    }
    // Returns the map for normals, the inverse transpose of the linear part. Not finite when there is no
    // inverse.
    NodeMatrix of_normals() const {
        const auto& [a, b, c, d] = row;
        const float by = 1 / determinant();
        NodeMatrix m;
        m.row[0] = {by * (b[1] * c[2] - b[2] * c[1]), -by * (b[0] * c[2] - b[2] * c[0]),
                    by * (b[0] * c[1] - b[1] * c[0]), 0};
        m.row[1] = {-by * (a[1] * c[2] - a[2] * c[1]), by * (a[0] * c[2] - a[2] * c[0]),
                    -by * (a[0] * c[1] - a[1] * c[0]), 0};
        m.row[2] = {by * (a[1] * b[2] - a[2] * b[1]), -by * (a[0] * b[2] - a[2] * b[0]),
                    by * (a[0] * b[1] - a[1] * b[0]), 0};
        return m;
    }
    // Returns the normal transformed by such a map, as a unit vector; zero when it has no length.
    Vec3f turn_normal(Vec3f n) const {
        const Vec3f v{along(0, n), along(1, n), along(2, n)};
        const float size = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
        return size > 0 && std::isfinite(size) ? v / size : Vec3f{};
    }

    friend NodeMatrix operator*(const NodeMatrix& a, const NodeMatrix& b) {
        NodeMatrix out;
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t k = 0; k < 4; ++k)
                out.row[i][k] = a.row[i][0] * b.row[0][k] + a.row[i][1] * b.row[1][k] +
                                a.row[i][2] * b.row[2][k] + a.row[i][3] * b.row[3][k];
        return out;
    }
};

}  // namespace hilcam
