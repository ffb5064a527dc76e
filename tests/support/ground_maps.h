#pragma once
// Maps of the ground for tests: waves whose heights follow from a formula; and rays that meet a mesh of terrain.

#include <cmath>
#include <limits>

#include "render/ground/ground_detail.h"
#include "render/ground/ground_raster.h"
#include "render/scene/embree_scene.h"
#include "render/scene/terrain.h"
#include "render/vocabulary/units.h"

namespace hilcam {

inline constexpr double kMoonRadius_m = 1737.4e3;

// The normal of a sphere at a longitude and latitude.
inline Vec3d place_on_sphere(double longitude_deg, double latitude_deg) {
    const double lon = longitude_deg * kDegree_rad, lat = latitude_deg * kDegree_rad;
    return {std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat)};
}

// A whole body in longitude from 180 W and latitude from 90 N, half as many rows as columns.
class WholeMap : public GroundRaster {
  public:
    WholeMap(int columns, double radius_m) {
        shape_.columns = columns, shape_.rows = columns / 2;
        shape_.spacing_m = 2 * kPi * radius_m / columns;
        shape_.whole_turn = shape_.pole_above_first_row = shape_.pole_below_last_row = true;
    }
    void find_posts(std::span<const Vec3d> places, std::span<Vec2d> posts) override {
        for (std::size_t i = 0; i < places.size(); ++i) {
            const double turn = std::atan2(places[i].y, places[i].x) / (2 * kPi) + 0.5;
            const double down = std::acos(std::fmin(1, std::fmax(-1, places[i].z))) / kPi;
            const double x = turn * shape_.columns - 0.5;
            posts[i] = {x >= shape_.columns - 0.5 ? x - shape_.columns : x, down * shape_.rows - 0.5};
        }
    }
    void read(int level, int column, int row, int columns, int rows, std::span<float> values) override {
        std::size_t k = 0;
        for (int y = row; y < row + rows; ++y)
            for (int x = column; x < column + columns; ++x) {
                double sum = 0;
                for (int j = 0; j < 1 << level; ++j)
                    for (int i = 0; i < 1 << level; ++i) sum += height_m((x << level) + i, (y << level) + j);
                values[k++] = static_cast<float>(std::ldexp(sum, -2 * level));
            }
    }
    virtual double height_m(int column, int row) const = 0;  // height of a post
};

// Waves go around in whole numbers, and are lower where meridians come together.
class WaveMap final : public WholeMap {
  public:
    WaveMap(int columns, double amplitude_m, double radius_m)
        : WholeMap(columns, radius_m), amplitude_m_(amplitude_m) {}
    double height_m(int column, int row) const override {
        const double turn = 2 * kPi * column / shape_.columns, down = kPi * (row + 0.5) / shape_.rows;
        return amplitude_m_ * std::sin(down) * std::sin(down) * std::sin(90 * turn) * std::cos(110 * down);
    }

  private:
    double amplitude_m_;
};

// The heights of a detail.
class DetailMap final : public WholeMap {
  public:
    DetailMap(int columns, const GroundDetail& detail, double radius_m)
        : WholeMap(columns, radius_m), detail_(detail) {}
    double height_m(int column, int row) const override {
        const double lon = 2 * kPi * ((column + 0.5) / shape_.columns - 0.5),
                     down = kPi * (row + 0.5) / shape_.rows;
        const Vec3d place{std::sin(down) * std::cos(lon), std::sin(down) * std::sin(lon), std::cos(down)};
        double height_m = 0;
        const GroundPatch patch{1, {&place, 1}, {&height_m, 1}, {}, place, 0, 0.25 * shape_.spacing_m};
        detail_.add_wide(patch);
        detail_.add(patch);
        return height_m;
    }

  private:
    const GroundDetail& detail_;
};

// Finds where rays meet a mesh of terrain.
class TerrainRays {
  public:
    explicit TerrainRays(const TerrainMesh& terrain) : anchor_m_(terrain.anchor_m) {
        PreparedMesh prepared = embree_.prepare(terrain.mesh);
        embree_.adopt(0, prepared);
    }
    // Returns the distance along a unit direction; infinity: nothing is met. Terrain axes.
    double distance_m(Vec3d from_m, Vec3d dir) const {
        RayPacket rays;
        rays.count = 1;
        rays.set(0, to_float(from_m - anchor_m_), to_float(dir), 0, std::numeric_limits<float>::infinity());
        HitPacket hits;
        embree_.intersect_with(0, rays, hits);
        return hits.object[0] == HitPacket::kMiss ? std::numeric_limits<double>::infinity()
                                                  : static_cast<double>(hits.distance[0]);
    }

  private:
    static Mesh triangle() {
        Mesh mesh;
        mesh.vertices_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        mesh.triangles = {{0, 1, 2}};
        return mesh;
    }
    Mesh first_ = triangle();
    EmbreeScene embree_{std::vector<std::vector<const Mesh*>>{{&first_}}, true};
    Vec3d anchor_m_;
};

}  // namespace hilcam
