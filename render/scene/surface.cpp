#include "render/scene/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

std::uint32_t snorm16(float value) {
    const float scaled = std::round(std::clamp(value, -1.0f, 1.0f) * 32767.0f);
    return static_cast<std::uint16_t>(static_cast<std::int16_t>(scaled));
}

using Extent = std::array<Vec3f, 2>;
constexpr float kEndless = std::numeric_limits<float>::infinity();
constexpr Extent kNoExtent{Vec3f{kEndless, kEndless, kEndless}, Vec3f{-kEndless, -kEndless, -kEndless}};

std::vector<Extent> clusters_of(const Mesh& mesh) {
    std::vector<Extent> boxes;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const bool first = i % kClusterTriangles == 0;
        if (first) boxes.push_back(kNoExtent);
        // Neighbours share most of their corners.
        const auto& before = mesh.triangles[first ? i : i - 1];
        for (const std::uint32_t vertex : mesh.triangles[i])
            if (first || (vertex != before[0] && vertex != before[1] && vertex != before[2]))
                grow(boxes.back(), mesh.vertices_m[vertex]);
    }
    return boxes;
}

PackedColor pack_color(Vec3f c) {
    const auto packed = [](float value) {
        return static_cast<std::uint16_t>(std::clamp(std::round(kColorSteps * value), 0.0f, 65535.0f));
    };
    return {packed(c.x), packed(c.y), packed(c.z)};
}

// Square root of the areas' ratio.
float density_of(const Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
    const Vec3f a = mesh.vertices_m[t[0]];
    const float area = length(cross(mesh.vertices_m[t[1]] - a, mesh.vertices_m[t[2]] - a));
    const Vec2f p = mesh.uvs[t[0]], q = mesh.uvs[t[1]], r = mesh.uvs[t[2]];
    const float uv_area = std::abs((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x));
    return area > 0 ? std::sqrt(uv_area / area) : 0.0f;
}

}  // namespace

void grow(std::array<Vec3f, 2>& box_m, Vec3f to_m) {
    auto& [least, most] = box_m;
    least = {std::min(least.x, to_m.x), std::min(least.y, to_m.y), std::min(least.z, to_m.z)};
    most = {std::max(most.x, to_m.x), std::max(most.y, to_m.y), std::max(most.z, to_m.z)};
}

std::uint32_t pack_normal(Vec3f n) {
    const float sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    float x = n.x / sum;
    float y = n.y / sum;
    if (n.z < 0) {
        const float folded_x = (1 - std::abs(y)) * std::copysign(1.0f, x);
        y = (1 - std::abs(x)) * std::copysign(1.0f, y);
        x = folded_x;
    }
    return snorm16(x) | (snorm16(y) << 16);
}

ObjectSurfaces::ObjectSurfaces(const Mesh& mesh, std::vector<Material> materials_of_surfaces,
                               std::shared_ptr<const std::vector<MipTexture>> textures_of_object)
    : materials(std::move(materials_of_surfaces)),
      textures(std::move(textures_of_object)),
      cluster_bounds_m(clusters_of(mesh)) {
    HILCAM_CHECK(materials.size() == mesh.surfaces.size());
    for (const Vec3f& v : mesh.vertices_m) radius_m = std::max(radius_m, dot(to_double(v), to_double(v)));
    radius_m = std::sqrt(radius_m);
    const bool no_normals = mesh.normals.empty();
    const bool textured = !mesh.uvs.empty() && std::any_of(materials.begin(), materials.end(),
                                                           [](const Material& m) { return m.texture >= 0; });
    if (!textured)
        for (Material& material : materials) material.texture = -1;
    for (Material& material : materials) material.colored = !mesh.colors.empty();
    triangles.reserve(mesh.triangles.size());
    if (textured) {
        corner_uvs.resize(mesh.triangles.size());
        uv_per_m.resize(mesh.triangles.size());
    }
    if (!mesh.colors.empty()) corner_colors.reserve(mesh.triangles.size());
    if (!mesh.hapke.empty()) corner_hapke.resize(mesh.triangles.size());
    std::vector<std::uint32_t> normals(mesh.normals.size());
    // A zero normal means that the file has none here.
    std::vector<std::uint8_t> missing(mesh.normals.size());
    for (std::size_t i = 0; i < normals.size(); ++i) {
        missing[i] = dot(mesh.normals[i], mesh.normals[i]) > 0 ? 0 : 1;
        if (!missing[i]) normals[i] = pack_normal(mesh.normals[i]);
    }
    std::vector<PackedColor> colors(mesh.colors.size());
    std::transform(mesh.colors.begin(), mesh.colors.end(), colors.begin(), pack_color);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& [a, b, c] = mesh.triangles[i];
        const bool flat = no_normals || (missing[a] | missing[b] | missing[c]) != 0;
        triangles.push_back(
            {flat ? std::array<std::uint32_t, 3>{} : std::array{normals[a], normals[b], normals[c]},
             mesh.surface_of_triangle[i], static_cast<std::uint8_t>(flat), 0});
        if (textured) corner_uvs[i] = {mesh.uvs[a], mesh.uvs[b], mesh.uvs[c]};
        if (!mesh.colors.empty()) corner_colors.push_back({colors[a], colors[b], colors[c]});
        if (!mesh.hapke.empty()) corner_hapke[i] = {mesh.hapke[a], mesh.hapke[b], mesh.hapke[c]};
        if (textured) uv_per_m[i] = density_of(mesh, mesh.triangles[i]);
    }
}

}  // namespace hilcam
