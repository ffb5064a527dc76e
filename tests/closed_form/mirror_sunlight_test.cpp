// Sunlight that a flat mirror throws on a plate (mirror_sunlight.h), against what its plane and its reflection
// law say.

#include <gtest/gtest.h>

#include <cmath>

#include "render/probes/flat_mirrors.h"
#include "render/scene/brdf.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

constexpr double kPaint = 0.8, kSilvered = 0.9;
constexpr float kHalfLength_m = 0.5f, kHalfWidth_m = 0.4f;
const Vec3f kMiddle_m{-2.5f, 0, 2};
const float kSlant = std::sqrt(0.5f);

MaterialConfig silver(double roughness) {
    MaterialConfig m;
    m.model = roughness > 0 ? kModel<brdf::Metal> : kModel<brdf::Mirror>;
    m.reflectance = Curve::constant(kSilvered);
    m.roughness = roughness;
    return m;
}

SceneObject rectangle(Vec3f middle, Vec3f a, Vec3f b, const MaterialConfig& material,
                      const SpectralGrid& grid) {
    return object_of({middle - a - b, middle + a - b, middle + a + b, middle - a + b}, {{0, 1, 2}, {0, 2, 3}},
                     material, grid);
}

// Before the camera, to its left, a white plate that faces it and that the Sun, far to the right and a little
// behind it, does not light; and before the plate a mirror at 45 degrees, out of the picture, that throws the
// Sun on it.
class Mirrored {
  public:
    Stage s;

    explicit Mirrored(const char* model, double roughness = 0, int samples = 2) : roughness_(roughness) {
        s.quality.path_model = model;
        s.quality.max_depth = 8;
        s.quality.contribution_threshold = 0;
        s.quality.samples_per_axis = samples;
        s.quality.rays_across = 0;
        s.camera(160, 1.0);
        s.sun({1, 0, 0.02});
    }
    SceneObject plate() const {
        return rectangle({-2.5f, 0, 4}, {2, 0, 0}, {0, 1.5f, 0}, lambert(kPaint), s.grid);
    }
    SceneObject mirror() const {
        return rectangle(kMiddle_m, kHalfLength_m * Vec3f{kSlant, 0, -kSlant}, {0, kHalfWidth_m, 0},
                         silver(roughness_), s.grid);
    }
    void add(SceneObject object) { s.add(std::move(object), {0, 0, 0}, {0, 0, 0}); }
    void add_both(bool apart) {
        if (apart)
            add(plate()), add(mirror());
        else
            add(joined(plate(), mirror()));
    }
    // What the plate would send in the full Sun.
    static double white() { return kPaint / kPi * static_cast<double>(kSun_w_m2_um); }
    // Radiance at a place of the plate.
    double at(double x_m, double y_m) const {
        const double per = s.geometry.focal_length_px / 4;
        return static_cast<double>(
            s.radiance.row(static_cast<int>(80 + per * y_m))[static_cast<std::size_t>(80 + per * x_m)]);
    }

  private:
    double roughness_;
};

// The light's middle has R times what the Sun would give from there; its outline is the mirror's, seen along
// it.
TEST(MirrorSunlight, AFlatMirrorThrowsItsOwnOutline) {
    for (const bool apart : {false, true})
        for (const char* visibility : {"rays", "buffer"}) {
            Mirrored m("cached", 0, 4);
            m.s.quality.visibility = visibility;
            m.add_both(apart);
            m.s.render();
            // From the plate the mirrored Sun is nearly straight above; Schlick's term at 45 degrees is
            // 0.002.
            const double cosine = 1 / std::hypot(1, 0.02);
            const double expected = (kSilvered + (1 - kSilvered) * 0.0022) * cosine * m.white();
            EXPECT_NEAR(m.at(-2.5, 0) / expected, 1, 0.005) << visibility << apart;
            // 0.02 to the side over 2 m. Of a pixel of 50 mm on the edge half is lit, about.
            const double middle_x = -2.5 + 0.02 * 2;
            const double half_x = static_cast<double>(kHalfLength_m * kSlant),
                         half_y = static_cast<double>(kHalfWidth_m);
            for (const double sign : {-1.0, 1.0}) {
                EXPECT_NEAR(m.at(middle_x + sign * (half_x - 0.06), 0) / expected, 1, 0.005) << sign;
                EXPECT_LT(m.at(middle_x + sign * (half_x + 0.06), 0) / expected, 0.01) << sign;
                EXPECT_NEAR(m.at(middle_x, sign * (half_y - 0.06)) / expected, 1, 0.005) << sign;
                EXPECT_LT(m.at(middle_x, sign * (half_y + 0.06)) / expected, 0.01) << sign;
            }
            const double share = 4 * 1.02 * half_x * half_y / 64;  // of the picture, 8 m across there
            // The mirror shows the plate its light again, 1 % more; and the buffer asks once a pixel.
            EXPECT_NEAR(m.s.mean() / (share * expected), 1, 0.03) << visibility << apart;
        }
}

// With the Sun as a disk the edge is the share of it that stands before the mirror: of an even disk, for an
// edge that lies x of its radii off the middle, 1/2 + (x sqrt(1 - x^2) + asin x) / pi.
TEST(MirrorSunlight, TheDiskMakesAPenumbra) {
    Stage s;
    s.quality.path_model = "cached";
    s.quality.sun_disk = true;
    s.quality.samples_per_axis = 16;
    s.quality.rays_across = 0;
    s.scene.limb_darkening = false;
    constexpr double kField = 0.015;
    s.camera(32, kField);
    s.sun({1, 0, 0});
    // Behind the camera, which casts no shadow; its edge lies 6 m from the plate and throws the middle of the
    // picture.
    const float half = kHalfLength_m * kSlant;
    s.add(rectangle({0, 0, 4}, {1, 0, 0}, {0, 1, 0}, lambert(kPaint), s.grid), {0, 0, 0}, {0, 0, 0});
    s.add(rectangle({-half, 0, half - 2}, {half, 0, -half}, {0, kHalfWidth_m, 0}, silver(0), s.grid),
          {0, 0, 0}, {0, 0, 0});
    s.render();
    const double radius_m = 6 * std::tan(std::acos(0.0) - std::acos(kSunRadius_m / kAstronomicalUnit_m));
    const double full = (kSilvered + (1 - kSilvered) * 0.0022) * Mirrored::white();
    double greatest = 0, least = 1;
    for (int column = 0; column < 32; ++column) {
        double mean = 0;
        for (int row = 0; row < 32; ++row)
            mean += static_cast<double>(s.radiance.row(row)[static_cast<std::size_t>(column)]) / 32 / full;
        const double x = std::clamp(-4 * kField * ((column + 0.5) / 16 - 1) / radius_m, -1.0, 1.0);
        // 8192 places of the disk: a standard deviation of 0.006 at most, and a pixel is a fifteenth of the
        // width.
        EXPECT_NEAR(mean, 0.5 + (x * std::sqrt(1 - x * x) + std::asin(x)) / kPi, 0.025) << column;
        greatest = std::max(greatest, mean), least = std::min(least, mean);
    }
    EXPECT_GT(greatest, 0.99);
    EXPECT_LT(least, 0.01);
}

// What a rough mirror throws, summed over its area with its reflection law.
double thrown_irradiance(const Material& material, Vec3f place) {
    const Bsdf silver{&material, material.ggx_alpha, material.base, material.highlight};
    const Vec3f normal{kSlant, 0, kSlant}, sun = normalized(Vec3f{1, 0, 0.02f});
    constexpr int kParts = 60;
    double sum = 0;
    for (int i = 0; i < kParts * kParts; ++i) {
        const float u = (static_cast<float>(i % kParts) + 0.5f) / kParts * 2 - 1,
                    v = (static_cast<float>(i / kParts) + 0.5f) / kParts * 2 - 1;
        const Vec3f way = place - (kMiddle_m + u * kHalfLength_m * Vec3f{kSlant, 0, -kSlant} +
                                   Vec3f{0, v * kHalfWidth_m, 0});
        const Vec3f dir = normalized(way);
        const Cosines c{dot(normal, dir), dot(normal, sun), dot(dir, sun)};
        sum += static_cast<double>(c.ni * brdf_value(silver, c)[0] * c.no * dir.z / dot(way, way));
    }
    return sum * 4 * static_cast<double>(kHalfLength_m * kHalfWidth_m) / (kParts * kParts);
}
TEST(MirrorSunlight, ARoughMirrorThrowsWhatItsLobeSays) {
    for (const double roughness : {0.2, 0.33}) {
        Mirrored m("cached", roughness);
        m.add_both(true);
        m.s.render();
        const SceneObject mirror = m.mirror();
        double thrown = 0, seen = 0;
        for (double y = -0.975; y < 1; y += 0.05)
            for (double x = -3.475; x < -1.5; x += 0.05) {
                const double formula =
                    thrown_irradiance(mirror.materials[0], {static_cast<float>(x), static_cast<float>(y), 4});
                const double kept = m.at(x, y) / m.white();
                EXPECT_NEAR(kept, formula, 0.045) << roughness << " at " << x << ", " << y;
                thrown += formula, seen += kept;
            }
        EXPECT_NEAR(seen / thrown, 1, 0.02) << roughness;
    }
}

// Random paths find the same light where the mirror is rough and many are sent.
TEST(MirrorSunlight, IsWhatRandomPathsFind) {
    const auto light = [](const char* model, int samples) {
        Mirrored m(model, 0.33, samples);
        m.s.quality.facets_behind_diffuse = 0;
        m.s.quality.max_depth = 2;
        m.add_both(true);
        m.s.render();
        return m.s.mean();
    };
    EXPECT_NEAR(light("cached", 2) / light("path", 16), 1, 0.05);
}

// Something small and black on the way, before the mirror and behind it: its shadow lies in the light's
// middle.
TEST(MirrorSunlight, WhatStandsInTheWayCastsAShadow) {
    for (const double roughness : {0.0, 0.2}) {
        Mirrored free("cached", roughness);
        free.add_both(true);
        free.s.render();
        for (const bool before : {true, false}) {
            Mirrored m("cached", roughness);
            m.add_both(true);
            if (before)
                m.add(rectangle({-2.49f, 0, 3}, {0.1f, 0, 0}, {0, 0.1f, 0}, lambert(0), m.s.grid));
            else
                m.add(rectangle({-1.5f, 0, 2.02f}, {0, 0, 0.1f}, {0, 0.1f, 0}, lambert(0), m.s.grid));
            m.s.render();
            EXPECT_GT(free.at(-2.48, 0), 0.7 * m.white());
            EXPECT_LT(m.at(-2.48, 0), 0.01 * m.white()) << roughness << before;
            EXPECT_NEAR(m.at(-2.48, 0.2) / free.at(-2.48, 0.2), 1, 0.01) << roughness << before;
        }
    }
}

TEST(MirrorSunlight, AnEclipseTakesIt) {
    Mirrored m("cached");
    m.add_both(true);
    m.s.earth(0.3);
    m.s.world.bodies[BodyId::kEarth].world_m = {9e6, 0, 0.02 * 9e6};
    m.s.render();
    EXPECT_LT(m.at(-2.5, 0), 1e-5 * m.white());
}

// A frame does not depend on those before it, and no seed on any.
TEST(MirrorSunlight, NothingIsLeftToChance) {
    Mirrored m("cached", 0.2);
    m.add_both(false);
    m.s.render();
    const std::vector<float> first(m.s.radiance.plane(0).begin(), m.s.radiance.plane(0).end());
    m.s.sun({1, 0, 0.3});
    m.s.render_again();
    EXPECT_FALSE(std::equal(first.begin(), first.end(), m.s.radiance.plane(0).begin()));
    m.s.sun({1, 0, 0.02});
    m.s.renderer->render(m.s.world, {2, 7}, m.s.radiance, m.s.points, m.s.stats);
    EXPECT_TRUE(std::equal(first.begin(), first.end(), m.s.radiance.plane(0).begin()));
}

std::vector<FlatMirror> mirrors_of(const SceneObject& object, std::vector<float> throws = {0.9f}) {
    const ObjectSurfaces surfaces(object.mesh, object.materials, nullptr);
    return find_flat_mirrors({object.mesh.vertices_m, object.mesh.triangles}, surfaces, throws);
}

TEST(FlatMirrors, AreFoundInTheMesh) {
    const SpectralGrid grid{{0.5, 0.6}};
    const std::vector<FlatMirror> one = mirrors_of(plate(silver(0), grid));
    ASSERT_EQ(one.size(), 1u);
    EXPECT_NEAR(one[0].area_m2, 4, 1e-5);
    EXPECT_NEAR(one[0].filled({1, 1}, {0.5f, 0.5f}), 1, 1e-6);
    EXPECT_NEAR(one[0].filled({0, 1}, {0.5f, 0.5f}), 0.5, 1e-6);
    EXPECT_NEAR(one[0].filled({1, 1}, {4, 8}), 1.0 / 8, 1e-6);
    EXPECT_EQ(one[0].filled({3, 1}, {0.5f, 0.5f}), 0);
    EXPECT_EQ(mirrors_of(cube(silver(0), grid)).size(), 6u);
    EXPECT_TRUE(mirrors_of(plate(silver(0), grid), {0}).empty());
    // A sphere is curved: its corner normals say so.
    EXPECT_TRUE(mirrors_of(sphere(40, silver(0), grid)).empty());
}

// Sixteen tiles, each leaning otherwise by a twentieth of a degree, with gaps between them.
TEST(FlatMirrors, TilesInAPlaneAreOne) {
    const SpectralGrid grid{{0.5, 0.6}};
    std::vector<Vec3f> v;
    std::vector<std::array<std::uint32_t, 3>> t;
    for (int i = 0; i < 16; ++i) {
        const float x = static_cast<float>(i % 4), y = static_cast<float>(i / 4),
                    lean = i % 2 ? 8e-4f : -8e-4f;
        const auto n = static_cast<std::uint32_t>(v.size());
        for (const Vec3f corner : {Vec3f{x, y, 0}, Vec3f{x + 0.9f, y, 0}, Vec3f{x + 0.9f, y + 0.9f, lean},
                                   Vec3f{x, y + 0.9f, lean}})
            v.push_back(corner);
        t.push_back({n, n + 1, n + 2}), t.push_back({n, n + 2, n + 3});
    }
    const std::vector<FlatMirror> found = mirrors_of(object_of(v, t, silver(0), grid));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(found[0].area_m2, 16 * 0.81, 1e-3);
    EXPECT_NEAR(found[0].filled({1.95f, 1.95f}, {3.9f, 3.9f}), 16 * 0.81 / (3.9 * 3.9), 0.01);
}

}  // namespace
}  // namespace hilcam
