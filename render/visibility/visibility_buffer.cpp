#include "render/visibility/visibility_buffer.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/scene/coplanar_groups.h"
#include "render/scene/surface.h"
#include "render/visibility/cut_triangles.h"
#include "render/visibility/potentially_visible_sets.h"

namespace hilcam {
namespace {

constexpr std::size_t kRun =
    kClusterTriangles;                        // triangles that are processed between two visits of the tiles
constexpr std::size_t kVertexRun = 1 << 14;   // vertices per task
constexpr std::uint32_t kBlocksAtOnce = 32;   // blocks that a group reserves at once
constexpr std::size_t kBlocksTogether = 256;  // blocks of a tile that are sorted together

}  // namespace

VisibilityBuffer::VisibilityBuffer(const ImageGeometry& geometry, const Capacity& capacity)
    : geometry_(geometry),
      lens_(geometry),
      capacity_(capacity),
      tiles_across_((geometry.padded_width() + kVisibilityTile_px - 1) / kVisibilityTile_px),
      tiles_down_((geometry.padded_height() + kVisibilityTile_px - 1) / kVisibilityTile_px) {
    const auto tiles = static_cast<std::size_t>(tiles_across_ * tiles_down_);
    placed_.reserve(capacity.objects);
    vertices_.resize(capacity.vertices);
    first_.resize(tiles * kGroups);
    // Most triangles are in one tile or none; on average half of a block's sixteen entries are used.
    constexpr std::size_t kMin = 1 << 16;  // for few triangles that fill the screen many times
    const std::size_t blocks = capacity.triangles / 4 + 32 * tiles + kMin;
    blocks_.resize(blocks);
    heads_.resize(blocks);
    if (capacity.rows) rows_.emplace(geometry.padded_height());
}

bool VisibilityBuffer::take(const Pose& camera, std::span<const Shown> shown) {
    world_from_camera_ = to_matrix(camera.world_from_body);
    const Mat3d camera_from_world = transposed(world_from_camera_);
    placed_.clear();
    drawn_count_ = 0;
    std::size_t vertices = 0, triangles = 0;
    depth_origin_m_ = 0;
    for (const Shown& object : shown) {
        if (placed_.size() == capacity_.objects) return false;
        const Vec3d offset_m = object.pose.position_world_m - camera.position_world_m;
        const Mat3d world_from_body = to_matrix(object.pose.world_from_body);
        const Mat3d camera_from_body = camera_from_world * world_from_body;
        const Vec3d origin_camera_m = camera_from_world * offset_m;
        const PotentiallyVisibleSet* const set = object.visible;
        const MeshView drawn = set ? MeshView{set->vertices_m, set->triangles} : object.mesh;
        placed_.push_back({object,
                           drawn,
                           set ? std::span<const std::uint32_t>(set->ids) : object.coplanar_groups,
                           vertices,
                           drawn_count_,
                           triangles,
                           world_from_body,
                           offset_m,
                           {camera_from_body, origin_camera_m},
                           {},
                           planes_of(camera_from_body, origin_camera_m)});
        vertices += drawn.vertices_m.size();
        drawn_count_ += drawn.triangles.size();
        triangles += object.mesh.triangles.size();
        if (vertices > capacity_.vertices || triangles > capacity_.triangles) return false;
        const double near_m = std::max(length(offset_m), object.radius_m);
        if (depth_origin_m_ == 0 || near_m < depth_origin_m_) depth_origin_m_ = near_m;
    }
    for (Placed& object : placed_) object.projection = projection(object, object.in_camera);
    return true;
}

ScreenProjection VisibilityBuffer::projection(const Placed& placed, const InCamera& at) const {
    return screen_projection(geometry_, at, placed.shown.radius_m, depth_origin_m_);
}

InCamera VisibilityBuffer::in_camera(const Placed& placed, const RowPoses::At& at) {
    const Mat3d camera_from_world = transposed(at.world_from_camera);
    return {camera_from_world * placed.world_from_body, camera_from_world * (placed.offset_m - at.moved_m)};
}

float VisibilityBuffer::roll(const Placed& placed, std::span<const Vec3f> vertices_m,
                             ScreenVertex* out) const {
    const InRollingCamera at{in_camera(placed, rows_->first()), placed.in_camera,
                             in_camera(placed, rows_->last())};
    return roll_vertices(vertices_m, rolling_projection(geometry_, at, depth_origin_m_), lens_.screen(), out);
}

// Projects all vertices in runs, regardless of object, so that many small objects use as many threads as a
// large one. Returns false if visible ones move too fast from row to row.
bool VisibilityBuffer::project() {
    std::atomic<bool> slow = true;
    const auto project_part = [&](std::size_t begin, std::size_t end) {
        auto object =
            std::upper_bound(placed_.begin(), placed_.end(), begin,
                             [](std::size_t at, const Placed& placed) { return at < placed.first_vertex; });
        for (--object; object != placed_.end() && object->first_vertex < end; ++object) {
            const std::span<const Vec3f> all = object->drawn.vertices_m;
            const std::size_t first = object->first_vertex;
            const std::size_t from = std::max(begin, first), to = std::min(end, first + all.size());
            if (from >= to) continue;
            const std::span<const Vec3f> part = all.subspan(from - first, to - from);
            if (!rolling_)
                project_vertices(part, object->projection, vertices_.data() + from);
            else if (roll(*object, part, vertices_.data() + from) > kMaxRowSpeed_px)
                slow = false;
        }
    };
    if (placed_.empty()) return true;
    const std::size_t count = placed_.back().first_vertex + placed_.back().drawn.vertices_m.size();
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kVertexRun),
                      [&](const auto& part) { project_part(part.begin(), part.end()); });
    return slow;
}

// Puts one group of triangles into the tiles that may show them.
class VisibilityBuffer::Sorter {
  public:
    Sorter(VisibilityBuffer& buffer, std::size_t group) : my_(buffer), group_(group) {}

    // Sorts triangles begin to end, numbered over all objects. Returns false if it runs out of room.
    bool sort(std::size_t begin, std::size_t end) {
        auto object =
            std::upper_bound(my_.placed_.begin(), my_.placed_.end(), begin,
                             [](std::size_t at, const Placed& placed) { return at < placed.first_drawn; });
        for (--object; object != my_.placed_.end() && object->first_drawn < end; ++object) {
            const std::size_t count = object->drawn.triangles.size();
            const std::size_t from = std::max(begin, object->first_drawn) - object->first_drawn;
            const std::size_t to = std::min(end - object->first_drawn, count);
            for (std::size_t first = from, next; first < to; first = next) {
                const std::size_t cluster = first / kRun;
                next = std::min(to, (cluster + 1) * kRun);
                const auto boxes_m = object->shown.cluster_bounds_m;
                if (!object->shown.visible && !boxes_m.empty() && !my_.may_show(*object, boxes_m[cluster]))
                    continue;
                if (!sort_run(*object, first, next - first)) return false;
            }
        }
        return true;
    }

  private:
    VisibilityBuffer& my_;
    std::size_t group_;
    std::uint32_t next_ = 0, end_ = 0;  // blocks that it has reserved
    std::array<TileRange, kRun> ranges_;

    bool sort_run(const Placed& object, std::size_t first, std::size_t count) {
        const std::span<const TriangleCorners> triangles = object.drawn.triangles.subspan(first, count);
        const ScreenVertex* const vertices = &my_.vertices_[object.first_vertex];
        const auto number = static_cast<std::uint32_t>(first);
        const int width_px = my_.geometry_.padded_width(), height_px = my_.geometry_.padded_height();
        const std::size_t found = my_.rolling_
                                      ? find_rolling_tiles(vertices, triangles, number, width_px, height_px,
                                                           my_.margin_px_, my_.lens_.screen(), ranges_.data())
                                      : find_tiles(vertices, triangles, number, width_px, height_px,
                                                   my_.lens_.screen(), ranges_.data());
        const auto placed = static_cast<std::uint32_t>(&object - my_.placed_.data());
        for (std::size_t i = 0; i < found; ++i) {
            TileRange& range = ranges_[i];
            if (!object.ids.empty() && object.ids[range.triangle] == kNotShown) continue;
            const bool cut = range.x1 < 0;
            if (!(cut ? add_cut(object, placed, range) : add_all(placed, range, false))) return false;
        }
        return true;
    }

    bool add_all(std::uint32_t placed, const TileRange& range, bool cut) {
        for (int y = range.y0; y <= range.y1; ++y)
            for (int x = range.x0; x <= range.x1; ++x)
                if (!add(static_cast<std::size_t>(y * my_.tiles_across_ + x), placed, range, cut))
                    return false;
        return true;
    }

    // Adds a triangle without an outline on the screen, which each row of tiles sets up at its own instants.
    bool add_cut(const Placed& object, std::uint32_t placed, TileRange range) {
        const auto bounds = [&](const InCamera& at, TileRange& out) {
            return bounds_of_cut(corners_m(object, at, range.triangle), my_.geometry_, my_.lens_, out);
        };
        if (!my_.rolling_) return !bounds(object.in_camera, range) || add_all(placed, range, true);
        for (int row = 0; row < my_.tiles_down_; ++row) {
            TileRange upper = range, lower = range;
            const bool in_upper =
                bounds(in_camera(object, my_.rows_->upper_edge(row * kVisibilityTile_px)), upper);
            const bool in_lower =
                bounds(in_camera(object, my_.rows_->lower_edge(row * kVisibilityTile_px)), lower);
            if (!in_upper && !in_lower) continue;
            if (!in_upper) upper = lower;
            if (!in_lower) lower = upper;
            if (std::min(upper.y0, lower.y0) > row || std::max(upper.y1, lower.y1) < row) continue;
            range.x0 = std::min(upper.x0, lower.x0), range.x1 = std::max(upper.x1, lower.x1);
            range.y0 = range.y1 = static_cast<std::int16_t>(row);
            if (!add_all(placed, range, true)) return false;
        }
        return true;
    }

    bool add(std::size_t tile, std::uint32_t placed, const TileRange& range, bool cut) {
        std::uint32_t& first = my_.first_[tile * kGroups + group_];
        if (first == kNoBlock || cut || my_.heads_[first].cut || my_.heads_[first].placed != placed ||
            my_.heads_[first].count == kTrianglesAtOnce) {
            if (next_ == end_) {
                next_ = my_.used_.fetch_add(kBlocksAtOnce);
                end_ = next_ + kBlocksAtOnce;
            }
            if (next_ >= my_.heads_.size()) return false;
            my_.heads_[next_] = {first, placed, 0, cut, range.nearest};
            my_.blocks_[next_].triangles.fill(0);
            first = next_++;
        }
        BlockHead& head = my_.heads_[first];
        my_.blocks_[first].triangles[head.count++] = range.triangle;
        head.nearest = std::max(head.nearest, range.nearest);
        return true;
    }
};

bool VisibilityBuffer::place(const Pose& camera, std::span<const Shown> shown, const RowMotion* rows,
                             int rows_px) {
    std::fill(first_.begin(), first_.end(), kNoBlock);
    used_ = 1;
    rolling_ = rows != nullptr;
    HILCAM_CHECK(!rolling_ || rows_);
    if (rolling_ && !rows_->place(*rows, geometry_, rows_px)) return false;
    if (!take(camera, shown)) return false;
    if (rolling_) margin_px_ = rolling_margin_px(geometry_, lens_.slopes(), *rows_, kMaxRowSpeed_px);
    if (!project()) return false;
    std::atomic<bool> room = true;
    tbb::parallel_for(std::size_t{0}, kGroups, [&](std::size_t group) {
        const std::size_t begin = drawn_count_ * group / kGroups;
        const std::size_t end = drawn_count_ * (group + 1) / kGroups;
        if (begin < end && !Sorter(*this, group).sort(begin, end)) room = false;
    });
    // The result must not depend on timing, but the blocks that groups reserve without using them do.
    return room && used_ + kGroups * kBlocksAtOnce <= heads_.size();
}

std::array<VisibilityBuffer::Placed::Plane, 5> VisibilityBuffer::planes_of(const Mat3d& camera_from_body,
                                                                           Vec3d origin_camera_m) const {
    const Mat3d body_from_camera = transposed(camera_from_body);
    const auto plane = [&](Vec3d along) {
        return Placed::Plane{body_from_camera * along, dot(along, origin_camera_m)};
    };
    const LensTiles::Slopes& s = lens_.slopes();
    return {plane({0, 0, 1}), plane({1, 0, -s.left}), plane({-1, 0, s.right}), plane({0, 1, -s.top}),
            plane({0, -1, s.bottom})};
}

// Returns false if all of the box is beyond one of the planes, for all rows. Positions on the screen are good
// to 1e-7 of their distance.
bool VisibilityBuffer::may_show(const Placed& placed, const std::array<Vec3f, 2>& box_m) const {
    const Vec3d least = to_double(box_m[0]), most = to_double(box_m[1]);
    const Vec3d middle = 0.5 * (least + most), half = 0.5 * (most - least);
    const double farthest_m = length(middle) + length(half) + length(placed.in_camera.origin_m);
    const double rounding_m = 1e-6 * farthest_m,
                 moves_m = rolling_ ? rows_->half_turn_rad() * farthest_m + rows_->half_way_m() : 0;
    return std::all_of(placed.planes.begin(), placed.planes.end(), [&](const Placed::Plane& plane) {
        const double reach_m = std::abs(plane.along.x) * half.x + std::abs(plane.along.y) * half.y +
                               std::abs(plane.along.z) * half.z;
        return dot(plane.along, middle) + plane.offset_m + reach_m >=
               -(rounding_m + moves_m * length(plane.along));
    });
}

CornersInCamera VisibilityBuffer::corners_m(const Placed& placed, const InCamera& at,
                                            std::uint32_t triangle) {
    CornersInCamera out;
    const TriangleCorners& corners = placed.drawn.triangles[triangle];
    for (std::size_t i = 0; i < 3; ++i)
        out[i] = at.camera_from_body * to_double(placed.drawn.vertices_m[corners[i]]) + at.origin_m;
    return out;
}

bool VisibilityBuffer::fill(int x_px, int y_px, VisibilityTile& tile) const {
    const std::uint32_t* first = &first_[tile_index(x_px, y_px) * kGroups];
    std::array<NearBlock, kBlocksTogether> blocks;
    std::size_t count = 0;
    bool any = false;
    for (std::size_t group = 0; group < kGroups; ++group) __builtin_prefetch(&heads_[first[group]]);
    const auto fill_those = [&] {
        if (!std::exchange(any, true)) tile.clear();
        fill_blocks(std::span(blocks).first(std::exchange(count, 0)), x_px, y_px, tile);
    };
    for (std::size_t group = 0; group < kGroups; ++group)
        for (std::uint32_t block = first[group]; block != kNoBlock; block = heads_[block].next) {
            __builtin_prefetch(&blocks_[block]);
            blocks[count] = {heads_[block].nearest, static_cast<std::uint32_t>(count), block};
            if (++count == blocks.size()) fill_those();
        }
    if (count > 0) fill_those();
    return any;
}

void VisibilityBuffer::prefetch_corners(std::uint32_t block) const {
    const Placed& placed = placed_[heads_[block].placed];
    for (const std::uint32_t triangle : std::span(blocks_[block].triangles).first(heads_[block].count)) {
        __builtin_prefetch(&placed.drawn.triangles[triangle]);
        if (!placed.ids.empty()) __builtin_prefetch(&placed.ids[triangle]);
    }
}

void VisibilityBuffer::prefetch_shading_points(std::uint32_t block) const {
    const Placed& placed = placed_[heads_[block].placed];
    for (const std::uint32_t triangle : std::span(blocks_[block].triangles).first(heads_[block].count))
        for (const std::uint32_t corner : placed.drawn.triangles[triangle])
            __builtin_prefetch(&vertices_[placed.first_vertex + corner]);
}

// Sets up a block's triangles for a tile.
void VisibilityBuffer::set_up(std::uint32_t block, int x_px, int y_px, TriangleSetup& setup) const {
    const BlockHead& head = heads_[block];
    const Placed& placed = placed_[head.placed];
    const auto& triangles = blocks_[block].triangles;
    const InCamera upper = rolling_ ? in_camera(placed, rows_->upper_edge(y_px)) : placed.in_camera,
                   lower = rolling_ ? in_camera(placed, rows_->lower_edge(y_px)) : placed.in_camera;
    const auto first = static_cast<std::uint32_t>(placed.first_triangle);
    if (head.cut) {
        const std::uint32_t number = triangles[0];
        return set_up_cut({corners_m(placed, upper, number), corners_m(placed, lower, number),
                           first + (placed.ids.empty() ? number : placed.ids[number]), depth_origin_m_},
                          lens_.view(x_px, y_px), setup);
    }
    const ScreenMesh mesh{&vertices_[placed.first_vertex], placed.drawn.triangles.data(), first,
                          placed.ids.empty() ? nullptr : placed.ids.data()};
    const TileLens* const lens = lens_.forward(x_px, y_px);
    if (!rolling_) return set_up_triangles(mesh, triangles, head.count, x_px, y_px, lens, setup);
    set_up_rolling_triangles(
        {mesh, placed.drawn.vertices_m.data(), projection(placed, upper), projection(placed, lower)},
        triangles, head.count, x_px, y_px, lens, setup);
}

// Fills blocks from near to far, so that hidden ones are found early.
void VisibilityBuffer::fill_blocks(std::span<NearBlock> blocks, int x_px, int y_px,
                                   VisibilityTile& tile) const {
    std::sort(blocks.begin(), blocks.end(), [](const NearBlock& a, const NearBlock& b) {
        return a.nearest != b.nearest ? a.nearest > b.nearest : a.order < b.order;
    });
    // Most tiles have only a few blocks, so the first ones are prefetched, too.
    constexpr std::size_t kCornersAhead = 4, kVerticesAhead = 2;
    const auto ask_for_corners = [&](std::size_t i) {
        if (i < blocks.size()) prefetch_corners(blocks[i].block);
    };
    const auto ask_for_vertices = [&](std::size_t i) {
        if (i < blocks.size()) prefetch_shading_points(blocks[i].block);
    };
    for (std::size_t i = 0; i < kCornersAhead; ++i) ask_for_corners(i);
    for (std::size_t i = 0; i < kVerticesAhead; ++i) ask_for_vertices(i);
    constexpr std::size_t kTriangles = 64;  // triangles between two updates of what is hidden
    TriangleSetup setup;
    std::size_t filled = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const auto& [nearest, order, block] = blocks[i];
        const BlockHead& head = heads_[block];
        if (nearest <= *std::min_element(tile.farthest.begin(), tile.farthest.end())) break;
        ask_for_corners(i + kCornersAhead), ask_for_vertices(i + kVerticesAhead);
        set_up(block, x_px, y_px, setup);
        fill_tile(setup, tile);
        filled += head.count;
        if (filled < kTriangles) continue;
        find_farthest(tile);
        filled = 0;
    }
}

Vec3d VisibilityBuffer::direction(int x_px, int y_px, Vec2f within_px) const {
    const int left = x_px / kVisibilityTile_px * kVisibilityTile_px,
              top = y_px / kVisibilityTile_px * kVisibilityTile_px;
    const Mat3d& world_from_camera = rolling_ ? rows_->of_row(y_px).world_from_camera : world_from_camera_;
    return world_from_camera * lens_.view(left, top).at(x_px - left + static_cast<double>(within_px.x),
                                                        y_px - top + static_cast<double>(within_px.y));
}

VisibilityBuffer::Seen VisibilityBuffer::seen(std::uint32_t id) const {
    std::size_t object = 0;
    if (placed_.size() > 1) {
        const auto after = std::upper_bound(
            placed_.begin(), placed_.end(), id,
            [](std::uint32_t at, const Placed& placed) { return at < placed.first_triangle; });
        object = static_cast<std::size_t>(after - placed_.begin()) - 1;
    }
    const Placed& placed = placed_[object];
    return {&placed.shown, id - static_cast<std::uint32_t>(placed.first_triangle)};
}

}  // namespace hilcam
