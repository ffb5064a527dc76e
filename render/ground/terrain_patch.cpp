#include "render/ground/terrain_patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <set>

namespace hilcam {
namespace {

constexpr int kStepsOfTile = 32;  // along a tile's edge
constexpr std::size_t kTileTriangles =
    2 * kStepsOfTile * kStepsOfTile + 8 * kStepsOfTile;  // triangles of a tile with its skirts

// A square of the map: its first column and row, and the spacing of the columns that it uses.
struct TerrainTile {
    int column = 0, row = 0, step = 1;
    double edge_px = 0;
    friend bool operator<(const TerrainTile& a, const TerrainTile& b) { return a.edge_px < b.edge_px; }
};

// Returns the place below a point, along the ground from the middle.
Vec2d ground_m(double radius_m, Vec3d p) {
    if (radius_m <= 0) return {p.x, p.y};
    const double across = std::hypot(p.x, p.y);
    const double angle = std::atan2(across, radius_m + p.z);
    return across > 0 ? Vec2d{p.x / across * angle * radius_m, p.y / across * angle * radius_m} : Vec2d{};
}
// Returns the same in columns and rows of the map.
Vec2d post_of(const HeightMap& map, double radius_m, Vec3d p) {
    const Vec2d at = ground_m(radius_m, p);
    return {at.x / map.spacing_m() + 0.5 * (map.columns() - 1),
            0.5 * (map.rows() - 1) - at.y / map.spacing_m()};
}

class TerrainBuilder {
  public:
    TerrainBuilder(const HeightMap& map, double radius_m, const TerrainView& view)
        : map_(map), radius_m_(radius_m), view_(view) {}

    TerrainMesh build() {
        TerrainMesh out;
        // Below the camera, or at the nearest point of the map.
        out.anchor_m = place(column_of(view_.camera_m), row_of(view_.camera_m));
        anchor_m_ = out.anchor_m;
        out.mesh.surfaces.resize(1);
        const std::vector<TerrainTile> all = tiles();
        for (const TerrainTile& tile : all) leaves_.insert(key_of(tile.column, tile.row, tile.step));
        for (const TerrainTile& tile : all) append(tile, out.mesh);
        out.mesh.surface_of_triangle.assign(out.mesh.triangles.size(), 0);
        return out;
    }

  private:
    const HeightMap& map_;
    double radius_m_;
    TerrainView view_;
    Vec3d anchor_m_;
    std::set<std::array<int, 3>> leaves_;

    static std::array<int, 3> key_of(int column, int row, int step) {
        const int span = step * kStepsOfTile;
        return {column / span, row / span, step};
    }
    // Returns the step of the tile that holds a point if it is coarser than `step`; otherwise `step`.
    int coarser_step(int column, int row, int step) const {
        if (column < 0 || row < 0 || column >= map_.columns() - 1 || row >= map_.rows() - 1) return step;
        for (int s = step; s * kStepsOfTile < 2 * std::max(map_.columns(), map_.rows()); s *= 2)
            if (leaves_.contains(key_of(column, row, s))) return s;
        return step;
    }

    // Returns a vertex of a tile, x and y counted in its steps. On the border to a coarser tile it is on that
    // tile's edge.
    Vec3d vertex_at(const TerrainTile& t, int x, int y) const {
        const int column = last_column(t.column + x * t.step), row = last_row(t.row + y * t.step);
        if (x == 0 || x == kStepsOfTile) {
            const int s = coarser_step(x == 0 ? t.column - 1 : t.column + kStepsOfTile * t.step,
                                       std::min(row, last_row(t.row + (kStepsOfTile - 1) * t.step)), t.step);
            if (s > t.step && row % s != 0) {
                const int above = row / s * s, below = last_row(above + s);
                const double share = static_cast<double>(row - above) / (below - above);
                return (1 - share) * place(column, above) + share * place(column, below);
            }
        }
        if (y == 0 || y == kStepsOfTile) {
            const int s = coarser_step(std::min(column, last_column(t.column + (kStepsOfTile - 1) * t.step)),
                                       y == 0 ? t.row - 1 : t.row + kStepsOfTile * t.step, t.step);
            if (s > t.step && column % s != 0) {
                const int left = column / s * s, right = last_column(left + s);
                const double share = static_cast<double>(column - left) / (right - left);
                return (1 - share) * place(left, row) + share * place(right, row);
            }
        }
        return place(column, row);
    }

    int clamped(double value, int count) const {
        return static_cast<int>(std::clamp(std::round(value), 0.0, static_cast<double>(count - 1)));
    }
    int column_of(Vec3d p) const { return clamped(post_of(map_, radius_m_, p).x, map_.columns()); }
    int row_of(Vec3d p) const { return clamped(post_of(map_, radius_m_, p).y, map_.rows()); }
    // Returns a point of the map in terrain axes.
    Vec3d place(int column, int row) const {
        const double x = (column - 0.5 * (map_.columns() - 1)) * map_.spacing_m();
        const double y = (0.5 * (map_.rows() - 1) - row) * map_.spacing_m();
        const double height = static_cast<double>(map_.height_m(column, row));
        if (radius_m_ <= 0) return {x, y, height};
        const double across = std::hypot(x, y), angle = across / radius_m_, r = radius_m_ + height;
        // (R + h) cos a - R without loss of digits: h cos a - 2 R sin^2(a/2).
        const double half = std::sin(0.5 * angle);
        const double scale = across > 0 ? r * std::sin(angle) / across : 0;
        return {scale * x, scale * y, height * std::cos(angle) - 2 * radius_m_ * half * half};
    }
    int last_column(int column) const { return std::min(column, map_.columns() - 1); }
    int last_row(int row) const { return std::min(row, map_.rows() - 1); }

    // Returns the width of the tile's edges on the screen, where it is nearest to the camera.
    double edge_px(const TerrainTile& t) const {
        const int span = t.step * kStepsOfTile;
        // The nearest point of a tile is close to the one below the camera if that is inside; otherwise it is
        // at the border.
        const int column = std::clamp(column_of(view_.camera_m), t.column, last_column(t.column + span));
        const int row = std::clamp(row_of(view_.camera_m), t.row, last_row(t.row + span));
        const double distance_m = std::max(length(place(column, row) - view_.camera_m), 1e-3);
        return t.step * map_.spacing_m() / distance_m / view_.pixel_rad;
    }

    std::vector<TerrainTile> tiles() const {
        int step = 1;
        while (step * kStepsOfTile < std::max(map_.columns(), map_.rows()) - 1) step *= 2;
        std::priority_queue<TerrainTile> open;
        const auto add = [&](TerrainTile t) {
            if (t.column >= map_.columns() - 1 || t.row >= map_.rows() - 1) return;
            t.edge_px = edge_px(t);
            open.push(t);
        };
        add({0, 0, step, 0});
        std::vector<TerrainTile> done;
        while (!open.empty()) {
            const TerrainTile t = open.top();
            const bool full = (done.size() + open.size() + 3) * kTileTriangles > view_.max_triangles;
            if (full || t.step == 1 || t.edge_px <= view_.edge_px) {
                open.pop();
                done.push_back(t);
                continue;
            }
            open.pop();
            const int half = t.step / 2, reach = half * kStepsOfTile;
            for (const int dy : {0, reach})
                for (const int dx : {0, reach}) add({t.column + dx, t.row + dy, half, 0});
        }
        return done;
    }

    Vec3f normal_at(int column, int row, int step) const {
        const Vec3d east = place(last_column(column + step), row) - place(std::max(0, column - step), row);
        const Vec3d north = place(column, std::max(0, row - step)) - place(column, last_row(row + step));
        return to_float(normalized(cross(east, north)));
    }

    void append(const TerrainTile& t, Mesh& mesh) const {
        const auto base = static_cast<std::uint32_t>(mesh.vertices_m.size());
        constexpr int kTileSide = kStepsOfTile + 1;
        for (int y = 0; y < kTileSide; ++y)
            for (int x = 0; x < kTileSide; ++x) {
                const int column = last_column(t.column + x * t.step), row = last_row(t.row + y * t.step);
                mesh.vertices_m.push_back(to_float(vertex_at(t, x, y) - anchor_m_));
                mesh.normals.push_back(normal_at(column, row, t.step));
            }
        const auto at = [&](int x, int y) { return base + static_cast<std::uint32_t>(y * kTileSide + x); };
        // Beyond the map's edge points coincide; those quadrilaterals are left out.
        const auto inside = [&](int x, int y) {
            return t.column + x * t.step < map_.columns() - 1 && t.row + y * t.step < map_.rows() - 1;
        };
        for (int y = 0; y < kStepsOfTile; ++y)
            for (int x = 0; x < kStepsOfTile; ++x) {
                if (!inside(x, y)) continue;
                mesh.triangles.push_back({at(x, y), at(x, y + 1), at(x + 1, y)});
                mesh.triangles.push_back({at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)});
            }
        for (int i = 0; i < kStepsOfTile; ++i) {
            skirt(t, i, 0, i + 1, 0, base, mesh);
            skirt(t, i + 1, kStepsOfTile, i, kStepsOfTile, base, mesh);
            skirt(t, 0, i + 1, 0, i, base, mesh);
            skirt(t, kStepsOfTile, i, kStepsOfTile, i + 1, base, mesh);
        }
    }

    // Adds a strip below the border between two points, so that rounding opens no gap.
    void skirt(const TerrainTile& t, int x0, int y0, int x1, int y1, std::uint32_t base, Mesh& mesh) const {
        constexpr int kTileSide = kStepsOfTile + 1;
        const auto down = [&](int x, int y) {
            const int column = last_column(t.column + x * t.step), row = last_row(t.row + y * t.step);
            const Vec3d edge = vertex_at(t, x, y);
            const Vec3d up = radius_m_ > 0 ? normalized(edge + Vec3d{0, 0, radius_m_}) : Vec3d{0, 0, 1};
            mesh.vertices_m.push_back(to_float(edge - 0.1 * t.step * map_.spacing_m() * up - anchor_m_));
            mesh.normals.push_back(normal_at(column, row, t.step));
            return static_cast<std::uint32_t>(mesh.vertices_m.size() - 1);
        };
        if (t.column + std::min(x0, x1) * t.step > map_.columns() - 1 ||
            t.row + std::min(y0, y1) * t.step > map_.rows() - 1)
            return;
        const std::uint32_t a = base + static_cast<std::uint32_t>(y0 * kTileSide + x0);
        const std::uint32_t b = base + static_cast<std::uint32_t>(y1 * kTileSide + x1);
        const std::uint32_t c = down(x0, y0), d = down(x1, y1);
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({b, d, c});
    }
};

}  // namespace

TerrainMesh terrain_mesh(const HeightMap& map, double radius_m, const TerrainView& view) {
    return TerrainBuilder(map, radius_m, view).build();
}

std::optional<double> height_above_ground_m(const HeightMap& map, double radius_m, Vec3d point_m) {
    const Vec2d post = post_of(map, radius_m, point_m);
    // The negation also catches NaN.
    if (!(post.x >= 0 && post.y >= 0 && post.x <= map.columns() - 1 && post.y <= map.rows() - 1)) return {};
    const int column = std::min(static_cast<int>(post.x), map.columns() - 2);
    const int row = std::min(static_cast<int>(post.y), map.rows() - 2);
    const double right = post.x - column, down = post.y - row;
    const auto height = [&](int c, int r) { return static_cast<double>(map.height_m(column + c, row + r)); };
    const double ground_m = (1 - down) * ((1 - right) * height(0, 0) + right * height(1, 0)) +
                            down * ((1 - right) * height(0, 1) + right * height(1, 1));
    if (radius_m <= 0) return point_m.z - ground_m;
    // |p + (0, 0, R)| - R without loss of digits.
    const double z = point_m.z, across_squared = point_m.x * point_m.x + point_m.y * point_m.y;
    const double from_center = std::sqrt(across_squared + (radius_m + z) * (radius_m + z));
    return (across_squared + z * (2 * radius_m + z)) / (from_center + radius_m) - ground_m;
}

}  // namespace hilcam
