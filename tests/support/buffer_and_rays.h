#pragma once
// What a camera sees by the visibility buffer beside what it sees by rays through the same samples, and meshes to look at.

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "render/scene/surface.h"
#include "render/visibility/visibility_buffer.h"
#include "render/vocabulary/units.h"

namespace hilcam {

// A camera that looks along its +z, and what it sees by the buffer and by rays through the same samples.
struct BufferAndRays {
    ImageGeometry geometry;
    Pose camera;
    std::vector<Mesh> meshes;
    std::vector<Pose> poses;
    std::vector<std::vector<std::array<Vec3f, 2>>> boxes_m;
    bool with_boxes = false;
    std::optional<RowMotion> rows;  // none: all rows are one instant
    std::unique_ptr<EmbreeScene> embree;
    std::unique_ptr<VisibilityBuffer> buffer;

    BufferAndRays(int width_px, int height_px, double focal_px) {
        geometry.width_px = width_px, geometry.height_px = height_px, geometry.guard_px = 3;
        geometry.focal_length_px = focal_px;
    }
    void add(Mesh mesh, const Pose& pose) {
        boxes_m.push_back(
            ObjectSurfaces(mesh, std::vector<Material>(mesh.surfaces.size()), nullptr).cluster_bounds_m);
        meshes.push_back(std::move(mesh)), poses.push_back(pose);
    }

    bool place() {
        std::vector<std::vector<const Mesh*>> levels;
        VisibilityBuffer::Capacity room{meshes.size(), 0, 0, rows.has_value()};
        for (const Mesh& mesh : meshes) {
            levels.push_back({&mesh});
            room.vertices += mesh.vertices_m.size(), room.triangles += mesh.triangles.size();
        }
        embree = std::make_unique<EmbreeScene>(levels, true);
        embree->place(poses, std::vector<std::size_t>(meshes.size()), camera.position_world_m);
        buffer = std::make_unique<VisibilityBuffer>(geometry, room);
        std::vector<VisibilityBuffer::Shown> shown;
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            double radius_m = 0;
            for (const Vec3f& v : meshes[i].vertices_m)
                radius_m = std::max(radius_m, static_cast<double>(length(v)));
            shown.push_back({static_cast<std::uint32_t>(i), poses[i], radius_m, embree->mesh(i, 0)});
            if (with_boxes) shown.back().cluster_bounds_m = boxes_m[i];
        }
        return buffer->place(camera, shown, rows ? &*rows : nullptr);
    }
    // Moves the camera while its rows are read.
    void roll(Vec3d velocity_world_m_s, Vec3d rate_body_rad_s, double line_time_s) {
        rows = {{{}, camera, velocity_world_m_s, rate_body_rad_s}, line_time_s, 0.5 * geometry.height_px};
    }

    struct Count {
        int samples = 0, seen_by_both = 0, only_buffer = 0, only_rays = 0, other_triangle = 0;
    };
    // by_tile: rays through the lens as its tiles have it, else through the lens itself. Where rows are of several instants, each
    // sample's ray is of its own.
    Count compare(bool by_tile = false) const {
        Count count;
        VisibilityTile tile;
        for (int ty = 0; ty < geometry.padded_height(); ty += kVisibilityTile_px)
            for (int tx = 0; tx < geometry.padded_width(); tx += kVisibilityTile_px) {
                if (!buffer->fill(tx, ty, tile)) tile.clear();
                const int x1 = std::min(tx + kVisibilityTile_px, geometry.padded_width());
                const int y1 = std::min(ty + kVisibilityTile_px, geometry.padded_height());
                for (int y = ty; y < y1; ++y)
                    for (int x = tx; x < x1; ++x) add_pixel(tile.ids(x - tx, y - ty), x, y, by_tile, count);
            }
        return count;
    }

  private:
    void add_pixel(const std::uint32_t* ids, int x, int y, bool by_tile, Count& count) const {
        RayPacket rays;
        HitPacket hits;
        rays.count = kVisibilitySamples;
        for (int i = 0; i < kVisibilitySamples; ++i) {
            const double y_px = y + static_cast<double>(sample_y(i)) - geometry.guard_px;
            const Pose at = rows ? rows->pose_at(y_px) : camera;
            const Vec3d dir = by_tile
                                  ? buffer->direction(x, y, {sample_x(i), sample_y(i)})
                                  : to_matrix(at.world_from_body) *
                                        geometry.direction_camera(
                                            x + static_cast<double>(sample_x(i)) - geometry.guard_px, y_px);
            rays.set(i, to_float(at.position_world_m - camera.position_world_m), to_float(dir), 0,
                     std::numeric_limits<float>::infinity());
        }
        embree->intersect(rays, Coherence::kIncoherent, hits);
        for (std::size_t i = 0; i < kVisibilitySamples; ++i) {
            ++count.samples;
            const bool by_rays = hits.object[i] != HitPacket::kMiss;
            const bool by_buffer = ids[i] != VisibilityTile::kNothing;
            if (by_rays && by_buffer) {
                ++count.seen_by_both;
                const VisibilityBuffer::Seen seen = buffer->seen(ids[i]);
                if (seen.triangle != hits.triangle[i] || seen.shown->object != hits.object[i])
                    ++count.other_triangle;
            } else if (by_rays) {
                ++count.only_rays;
            } else if (by_buffer) {
                ++count.only_buffer;
            }
        }
    }
};

inline Mesh sphere_mesh(float radius_m, int rings) {
    Mesh mesh;
    const int across = 2 * rings;
    for (int i = 0; i <= rings; ++i)
        for (int j = 0; j < across; ++j) {
            const float theta = static_cast<float>(i) * kPiF / static_cast<float>(rings);
            const float phi = static_cast<float>(j) * 2 * kPiF / static_cast<float>(across);
            mesh.vertices_m.push_back(radius_m * Vec3f{std::sin(theta) * std::cos(phi),
                                                       std::sin(theta) * std::sin(phi), std::cos(theta)});
        }
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * across + j % across); };
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < across; ++j) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    mesh.surface_of_triangle.resize(mesh.triangles.size());
    return mesh;
}

// Triangles anywhere in a cube, of all sizes.
inline Mesh debris(int count, float size_m, unsigned seed) {
    Mesh mesh;
    std::mt19937 engine(seed);
    std::uniform_real_distribution<float> place(-size_m, size_m);
    for (int i = 0; i < count; ++i) {
        const Vec3f at{place(engine), place(engine), place(engine)};
        const float scale = std::exp2(-8.0f * std::abs(place(engine)) / size_m);
        for (int k = 0; k < 3; ++k)
            mesh.vertices_m.push_back(at + scale * Vec3f{place(engine), place(engine), place(engine)});
        const auto n = static_cast<std::uint32_t>(3 * i);
        mesh.triangles.push_back({n, n + 1, n + 2});
    }
    mesh.surface_of_triangle.resize(mesh.triangles.size());
    return mesh;
}

inline Pose turned(Vec3d position_m) { return {position_m, normalized(Quat{0.7, 0.2, -0.5, 0.3})}; }

// A lens of a camera of 2000 px, with 5 % of barrel distortion in this corner of its picture and a little
// tangential.
inline void bend(BufferAndRays& sight) {
    sight.geometry.distortion.k1 = -0.25, sight.geometry.distortion.k2 = 0.1;
    sight.geometry.distortion.p1 = 1e-3, sight.geometry.distortion.p2 = -5e-4;
    sight.geometry.principal_offset_px = {-500, -300};
}

// What all samples see.
inline std::vector<std::uint32_t> ids_of(const BufferAndRays& sight) {
    std::vector<std::uint32_t> ids;
    VisibilityTile tile;
    for (int y = 0; y < sight.geometry.padded_height(); y += kVisibilityTile_px)
        for (int x = 0; x < sight.geometry.padded_width(); x += kVisibilityTile_px) {
            if (!sight.buffer->fill(x, y, tile)) tile.clear();
            ids.insert(ids.end(), tile.id.begin(), tile.id.end());
        }
    return ids;
}

}  // namespace hilcam
