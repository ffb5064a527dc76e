#include "render/lod/shaped_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "render/lod/mesh_lod.h"
#include "render/vocabulary/units.h"
#include "tests/support/wavy_plate.h"

namespace hilcam {
namespace {

// Adds a part of one surface.
void add(const Mesh& part, Mesh& mesh) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
    mesh.vertices_m.insert(mesh.vertices_m.end(), part.vertices_m.begin(), part.vertices_m.end());
    for (const auto& [a, b, c] : part.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
    mesh.surfaces.resize(1);
    mesh.surface_of_triangle.resize(mesh.triangles.size(), 0);
}

// A closed grid: place_m of turns from 0 to 1, and of heights from 0 to 1. Corners of their own for each triangle, as
// files without normals have them.
Mesh grid(int around, int up, const std::function<Vec3d(double, double)>& place_m) {
    Mesh mesh;
    const auto place = [&](int i, int j) {
        return to_float(place_m(static_cast<double>(i % around) / around, static_cast<double>(j) / up));
    };
    // Triangles without width, as a dish's middle would have, are left out.
    const auto add_triangle = [&](Vec3f a, Vec3f b, Vec3f c) {
        if (!(length(cross(b - a, c - a)) > 1e-9f)) return;
        const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
        mesh.vertices_m.insert(mesh.vertices_m.end(), {a, b, c});
        mesh.triangles.push_back({first, first + 1, first + 2});
    };
    for (int j = 0; j < up; ++j)
        for (int i = 0; i < around; ++i) {
            add_triangle(place(i, j), place(i + 1, j), place(i + 1, j + 1));
            add_triangle(place(i, j), place(i + 1, j + 1), place(i, j + 1));
        }
    mesh.surfaces.resize(1);
    mesh.surface_of_triangle.assign(mesh.triangles.size(), 0);
    return mesh;
}
Vec3d on_circle(double turn) { return {std::cos(2 * kPi * turn), std::sin(2 * kPi * turn), 0}; }

// A mast with pointed ends: an open one's ends would stay as they are in every level.
double mast_radius_m(double z_m) { return 0.05 * std::min({1.0, z_m / 0.2, (2 - z_m) / 0.2}); }
Mesh mast() {
    return grid(96, 40, [](double turn, double height) {
        return mast_radius_m(2 * height) * on_circle(turn) + Vec3d{0, 0, 2 * height};
    });
}
// Convex on its outer side, hollow on its inner one.
Mesh ring() {
    return grid(96, 24, [](double turn, double about) {
        const double out_m = 0.6 + 0.02 * std::cos(2 * kPi * about);
        return out_m * on_circle(turn) + Vec3d{0, 0, 0.02 * std::sin(2 * kPi * about)};
    });
}
Mesh dish() {
    return grid(64, 16, [](double turn, double out) {
        return out * on_circle(turn) + Vec3d{0, 0, 0.3 * out * out};
    });
}
// Foil about a cone: it goes round, but its wrinkles are bent far more.
Mesh crumpled_cone() {
    return grid(128, 64, [](double turn, double height) {
        const double wave_m = 0.004 * std::sin(2 * kPi * 16 * turn) * std::sin(2 * kPi * 8 * height);
        return (0.5 * (1 - 0.5 * height) + wave_m) * on_circle(turn) + Vec3d{0, 0, 0.5 * height};
    });
}

bool is_shaped(const Mesh& mesh) {
    const std::vector<bool> shaped = find_shaped(mesh);
    EXPECT_EQ(std::count(shaped.begin(), shaped.end(), shaped[0]), shaped.size());
    return shaped[0];
}

TEST(ShapedParts, MastsRingsAndDishesAreFoilAndPlatesAreNot) {
    EXPECT_FALSE(is_shaped(wavy_plate(64, 0, 1, 0.01)));
    EXPECT_FALSE(is_shaped(crumpled_cone()));
    EXPECT_TRUE(is_shaped(mast()));
    EXPECT_TRUE(is_shaped(ring()));
    EXPECT_TRUE(is_shaped(dish()));
    EXPECT_FALSE(is_shaped(wavy_plate(64, 0, 1, 0)));
    EXPECT_TRUE(find_shaped(Mesh{}).empty());
}

TEST(ShapedParts, PartsOfOneSurfaceAreToldApart) {
    Mesh mesh;
    add(mast(), mesh);
    const std::size_t first = mesh.triangles.size();
    add(wavy_plate(64, 0, 1, 0.01), mesh);
    const std::vector<bool> shaped = find_shaped(mesh);
    EXPECT_EQ(std::count(shaped.begin(), shaped.begin() + static_cast<std::ptrdiff_t>(first), false), 0);
    EXPECT_EQ(std::count(shaped.begin() + static_cast<std::ptrdiff_t>(first), shaped.end(), true), 0);
}

// Where the foil of the next test stands.
constexpr double kFoil_m = 20;

struct MastOfLevel {
    std::size_t triangles = 0;
    double deep_m = 0;  // how far its edges' middles are within the mast, at most
};
MastOfLevel mast_of(const Mesh& mesh) {
    MastOfLevel out;
    for (const auto& triangle : mesh.triangles) {
        if (static_cast<double>(mesh.vertices_m[triangle[0]].z) > kFoil_m / 2) continue;
        ++out.triangles;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3d middle_m = 0.5 * (to_double(mesh.vertices_m[triangle[k]]) +
                                          to_double(mesh.vertices_m[triangle[(k + 1) % 3]]));
            out.deep_m = std::max(out.deep_m, mast_radius_m(middle_m.z) - std::hypot(middle_m.x, middle_m.y));
        }
    }
    return out;
}

// Foil may lie anywhere within a level's error, a mast within an eighth of it: on the mean, as quadrics have it, so that
// single edges are up to half of it deep.
TEST(ShapedParts, LevelsKeepMastsRound) {
    Mesh mesh;
    Mesh foil = wavy_plate(128, 0, 2, 0.01);
    for (Vec3f& vertex : foil.vertices_m) vertex.z += static_cast<float>(kFoil_m);
    add(mast(), mesh);
    add(foil, mesh);
    std::size_t before = mast_of(mesh).triangles;
    const std::vector<MeshLevel> levels = coarser_levels(mesh);
    ASSERT_GE(levels.size(), 2u);
    for (const MeshLevel& level : levels) {
        const MastOfLevel found = mast_of(level.mesh);
        EXPECT_LT(found.deep_m, level.error_m / 2);
        // But for what is coarser than its own steps it has fewer of them.
        EXPECT_LE(found.triangles, before);
        before = found.triangles;
    }
    EXPECT_LT(mast_of(levels.back().mesh).triangles, mast_of(mesh).triangles / 4);
}

}  // namespace
}  // namespace hilcam
