#pragma once
// A stage for tests of the renderer: a camera at the origin, a Sun one au away, simple objects.

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "render/frame/renderer.h"
#include "render/probes/transfer_table.h"
#include "render/sky/body_photometry.h"
#include "render/vocabulary/units.h"

namespace hilcam {

inline constexpr float kSun_w_m2_um = 1000;

// A square plate of side 2 in its own xy plane, facing +z, one surface.
inline SceneObject plate(const MaterialConfig& material, const SpectralGrid& grid) {
    SceneObject object;
    object.mesh.vertices_m = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    object.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    object.mesh.surface_of_triangle = {0, 0};
    object.mesh.surfaces.resize(1);
    object.materials = {make_material(material, grid)};
    return object;
}

inline MaterialConfig lambert(double albedo) {
    MaterialConfig m;
    m.reflectance = Curve::constant(albedo);
    return m;
}

// A scene without air.
inline Scene copy_of(const Scene& scene) {
    Scene copy;
    copy.objects = scene.objects;
    copy.lamps = scene.lamps;
    copy.stars = scene.stars;
    copy.bodies = scene.bodies;
    copy.earth = scene.earth;
    copy.sun_irradiance_1au_w_m2_um = scene.sun_irradiance_1au_w_m2_um;
    copy.limb_darkening = scene.limb_darkening;
    copy.light_later = scene.light_later;
    return copy;
}

// An object with the vertices, triangles and one surface given.
inline SceneObject object_of(std::vector<Vec3f> vertices, std::vector<std::array<std::uint32_t, 3>> triangles,
                             const MaterialConfig& material, const SpectralGrid& grid) {
    SceneObject object;
    object.mesh.vertices_m = std::move(vertices);
    object.mesh.triangles = std::move(triangles);
    object.mesh.surface_of_triangle.resize(object.mesh.triangles.size());
    object.mesh.surfaces.resize(1);
    object.materials = {make_material(material, grid)};
    return object;
}

// One object of two, with the surfaces of both.
inline SceneObject joined(SceneObject a, const SceneObject& b) {
    const auto vertices = static_cast<std::uint32_t>(a.mesh.vertices_m.size());
    const auto surfaces = static_cast<std::uint16_t>(a.mesh.surfaces.size());
    a.mesh.vertices_m.insert(a.mesh.vertices_m.end(), b.mesh.vertices_m.begin(), b.mesh.vertices_m.end());
    for (const auto& t : b.mesh.triangles)
        a.mesh.triangles.push_back({t[0] + vertices, t[1] + vertices, t[2] + vertices});
    for (const std::uint16_t s : b.mesh.surface_of_triangle)
        a.mesh.surface_of_triangle.push_back(static_cast<std::uint16_t>(s + surfaces));
    a.mesh.surfaces.insert(a.mesh.surfaces.end(), b.mesh.surfaces.begin(), b.mesh.surfaces.end());
    a.materials.insert(a.materials.end(), b.materials.begin(), b.materials.end());
    return a;
}

// A cube of one metre about its origin.
inline SceneObject cube(const MaterialConfig& material, const SpectralGrid& grid, float size = 1) {
    std::vector<Vec3f> v;
    for (unsigned i = 0; i < 8; ++i)
        v.push_back(size * Vec3f{(i & 1u ? 0.5f : -0.5f), (i & 2u ? 0.5f : -0.5f), (i & 4u ? 0.5f : -0.5f)});
    return object_of(v,
                     {{0, 2, 1},
                      {1, 2, 3},
                      {4, 5, 6},
                      {5, 7, 6},
                      {0, 1, 4},
                      {1, 5, 4},
                      {2, 6, 3},
                      {3, 6, 7},
                      {0, 4, 2},
                      {2, 4, 6},
                      {1, 3, 5},
                      {3, 7, 5}},
                     material, grid);
}

// A sphere of one metre radius, smooth, of 2 rings^2 quadrilaterals; its middle cross section is right.
inline SceneObject sphere(int rings, const MaterialConfig& material, const SpectralGrid& grid) {
    std::vector<Vec3f> v;
    std::vector<std::array<std::uint32_t, 3>> t;
    const int spokes = 2 * rings;
    for (int i = 0; i <= rings; ++i)
        for (int j = 0; j < spokes; ++j) {
            const double theta = kPi * i / rings, phi = 2 * kPi * j / spokes;
            v.push_back(to_float(
                Vec3d{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)}));
        }
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < spokes; ++j) {
            const auto at = [&](int a, int b) { return static_cast<std::uint32_t>(a * spokes + b % spokes); };
            t.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
            t.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
        }
    SceneObject object = object_of(v, t, material, grid);
    object.mesh.normals = v;
    return object;
}

// A camera at the origin that looks along +z with y down; the Sun one au away in a direction; no Earth.
class Stage {
  public:
    SpectralGrid grid{{0.5, 0.6, 0.7}};
    ImageGeometry geometry{32, 32, 4, 32, {}};
    RenderQuality quality;
    TransferSettings transfer{.probes = 3000, .enclosed = true};
    Scene scene;
    WorldSnapshot world;
    RadianceImage radiance{40, 40, 2};
    RenderModels models;
    std::unique_ptr<Renderer> renderer;
    std::vector<PointSource> points;
    RenderStats stats;

    Stage() {
        for (int b = 0; b < 2; ++b) scene.sun_irradiance_1au_w_m2_um[b] = kSun_w_m2_um;
        world.bodies[BodyId::kEarth].world_m = {0, 0, -1e9};
        sun({0, 0, -1});
    }
    void earth(double albedo) {
        BodyConfig config = default_body(BodyId::kEarth);
        config.albedo = Curve::constant(albedo);
        scene.body(BodyId::kEarth) = {true, BodyLook(BodyId::kEarth, config, grid), {}};
    }
    void sun(Vec3d dir) { world.bodies.sun_world_m = kAstronomicalUnit_m * normalized(dir); }
    // Turned half about x, so that the plate's +z faces the camera. With path model `cached`, light is cached on
    // it.
    void add(SceneObject object, Vec3d position, Vec3d rotation = {kPi, 0, 0}) {
        if (quality.path_model == "cached")
            object.transfer = std::make_shared<const TransferTable>(
                object.mesh, std::vector<std::uint8_t>(object.mesh.surfaces.size()), transfer);
        scene.objects.push_back(std::move(object));
        world.objects.push_back({position, from_rotation_vector(rotation)});
    }
    void render() {
        build();
        render_again();
    }
    // Terrain, which cannot be copied, goes with the first.
    void build() {
        Scene copy = copy_of(scene);
        copy.terrain = std::move(scene.terrain);
        renderer = std::make_unique<Renderer>(std::move(copy), grid, geometry, quality, models);
    }
    // The same scene in another world.
    void render_again() {
        points.reserve(renderer->max_points());
        renderer->render(world, {1, 1}, radiance, points, stats);
    }
    // A square image of this size, and a field of `half_width` tangents on each side.
    void camera(int size_px, double half_width) {
        geometry = {size_px, size_px, 0, 0.5 * size_px / half_width, {}};
        radiance = RadianceImage(size_px, size_px, 2);
    }
    // Of the whole image, points included: irradiance [W m^-2 um^-1] for small fields, and centroid [px].
    struct Light {
        double irradiance = 0;
        Vec2d centroid_px;
    };
    Light light() const {
        Light out;
        const double solid_angle = 1 / (geometry.focal_length_px * geometry.focal_length_px);
        const auto add = [&](double amount, double x, double y) {
            out.irradiance += amount;
            out.centroid_px.x += amount * x, out.centroid_px.y += amount * y;
        };
        for (int y = 0; y < radiance.height(); ++y)
            for (int x = 0; x < radiance.width(); ++x)
                add(solid_angle * static_cast<double>(radiance.row(y)[static_cast<std::size_t>(x)]),
                    x + 0.5 - geometry.guard_px, y + 0.5 - geometry.guard_px);
        for (const PointSource& p : points)
            add(static_cast<double>(p.irradiance_w_m2_um[0]), static_cast<double>(p.position_px.x),
                static_cast<double>(p.position_px.y));
        out.centroid_px = {out.centroid_px.x / out.irradiance, out.centroid_px.y / out.irradiance};
        return out;
    }
    // The mean of all pixels, in the first bin.
    double mean() const {
        double sum = 0;
        for (const float value : radiance.plane(0)) sum += static_cast<double>(value);
        return sum / static_cast<double>(radiance.plane(0).size());
    }
    float middle(int bin = 0) const { return radiance.row(20, bin)[20]; }
};

}  // namespace hilcam
