#pragma once
// Finds which triangle each of sixteen samples in every pixel sees, for a pinhole camera at one instant: the
// one that rays would find, for less than one ray a pixel costs. Lenses that bend straight lines are affine
// in each tile (lens_tiles.h). Triangles are projected and sorted into tiles of the screen once a frame;
// tiles are filled one by one, when they are shaded.
//
// The rows of a rolling shutter each see the world from the camera's pose at their own instant (row_poses.h, rolling_raster.h).
//
// Not modelled: line scanners, fisheyes, lenses that bend much within a tile (takes()). Such frames are for rays, and so is a frame
// that shows more triangles than there is memory for, or whose rows see what moves fast: place() says no.
//
// Precision: places on the screen are good to a thousandth of a pixel, also of objects that are far against
// their size; depth to a few 1e-7 of the distance, or of the object where that is smaller. A triangle through
// the camera's plane is cut by exact homogeneous edges (Olano & Greer, Graphics Hardware 1997).

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "render/scene/embree_scene.h"
#include "render/visibility/cut_triangles.h"
#include "render/visibility/lens_tiles.h"
#include "render/visibility/row_poses.h"
#include "render/visibility/screen_projections.h"
#include "render/visibility/visibility_raster.h"
#include "render/visibility/visibility_tile.h"
#include "render/vocabulary/image_geometry.h"
#include "render/vocabulary/pixel_box.h"
#include "render/vocabulary/pose.h"

namespace hilcam {

struct PotentiallyVisibleSet;

class VisibilityBuffer {
  public:
    // The most that a frame may show.
    struct Capacity {
        std::size_t objects = 0, vertices = 0, triangles = 0;
        bool rows = false;  // its rows may be of several instants
    };
    // A frame whose rows are of several instants shows nothing that moves by more from one row to the next: what it sees at the upper and
    // lower border of a row of pixels is off by half of that [px].
    static constexpr float kMaxRowSpeed_px = 0.25f;
    static bool takes(const ImageGeometry& geometry) { return LensTiles::takes(geometry); }
    // Owner thread. The geometry is one that it takes.
    VisibilityBuffer(const ImageGeometry& geometry, const Capacity& capacity);

    // Looks through another lens, that leaves straight lines straight, from the next place() on. Loop.
    void set_focal_length(double focal_length_px) {
        geometry_.focal_length_px = focal_length_px;
        lens_ = LensTiles(geometry_);
    }

    // An object as a frame shows it.
    struct Shown {
        std::uint32_t object;
        Pose pose;
        double radius_m;
        MeshView mesh;  // outlives the frame
        // Boxes of its clusters (ObjectSurfaces), likewise: those beside the picture are left out. Empty: all triangles are looked at.
        std::span<const std::array<Vec3f, 2>> cluster_bounds_m{};
        // They say for each triangle which one's id stands for it, or that it is left out (coplanar_groups.h), likewise. Empty:
        // each has its own.
        std::span<const std::uint32_t> coplanar_groups{};
        // All that may be seen of it (potentially_visible_sets.h), likewise: the rest is not looked at. Null: all of it may be.
        const PotentiallyVisibleSet* visible = nullptr;
    };
    // Sorts the triangles of a frame. rows: how the camera moves between rows, each of which is rows_px of the buffer's; null: all
    // are one instant. False: there is no room for the triangles, or they move too fast. Loop.
    bool place(const Pose& camera, std::span<const Shown> shown, const RowMotion* rows = nullptr,
               int rows_px = 1);

    // Finds what a tile's samples see; x and y of its corner are multiples of kVisibilityTile_px. False:
    // nothing. Loop, any thread.
    bool fill(int x_px, int y_px, VisibilityTile& tile) const;
    // Does so for all tiles, one after the other; use(x_px, y_px) is called for each that sees something. Any thread.
    template <class Use>
    void fill_all(VisibilityTile& tile, const Use& use) const {
        for (int y = 0; y < geometry_.padded_height(); y += kVisibilityTile_px)
            for (int x = 0; x < geometry_.padded_width(); x += kVisibilityTile_px)
                if (fill(x, y, tile)) use(x, y);
    }

    // Returns the direction through a place in a pixel, as its tile has it; world axes, of any length.
    Vec3d direction(int x_px, int y_px, Vec2f within_px) const;
    // Returns the way of the camera, from its place at the frame's time to where it is when a row is read.
    Vec3d moved_m(int y_px) const { return rolling_ ? rows_->of_row(y_px).moved_m : Vec3d{}; }

    // The triangle for which an id of a tile stands.
    struct Seen {
        const Shown* shown;
        std::uint32_t triangle;
    };
    Seen seen(std::uint32_t id) const;

  private:
    static constexpr std::size_t kGroups = 64;  // groups of triangles, sorted side by side
    static constexpr std::uint32_t kNoBlock = 0;

    // Up to sixteen triangles of an object that a tile may see.
    struct alignas(64) Block {
        std::array<std::uint32_t, kTrianglesAtOnce> triangles;
    };
    struct BlockHead {
        std::uint32_t next = kNoBlock;
        std::uint32_t placed = 0;  // index of the object
        std::uint16_t count = 0;
        bool cut = false;   // one triangle, not wholly on the screen
        float nearest = 0;  // the greatest depth of all
    };
    // A block to be filled into a tile. The order is that of the groups: blocks' numbers depend on chance.
    struct NearBlock {
        float nearest;
        std::uint32_t order, block;
    };
    struct Placed {
        Shown shown;
        // The triangles that are drawn of it, and whose ids stand for its triangles; none: each has its own.
        MeshView drawn;
        std::span<const std::uint32_t> ids;
        std::size_t first_vertex, first_drawn;
        std::size_t first_triangle;  // id of the whole mesh' first
        Mat3d world_from_body;
        Vec3d offset_m;      // from the camera, world axes
        InCamera in_camera;  // at the frame's time
        ScreenProjection projection;
        // The picture's edges and the camera's plane, body axes: a place is within where along * place + offset_m is not below zero.
        struct Plane {
            Vec3d along;
            double offset_m;
        };
        std::array<Plane, 5> planes;
    };
    class Sorter;

    ImageGeometry geometry_;
    LensTiles lens_;
    Mat3d world_from_camera_;
    Capacity capacity_;
    int tiles_across_, tiles_down_;
    std::vector<Placed> placed_;
    double depth_origin_m_ = 1;
    std::size_t drawn_count_ = 0;         // triangles
    std::vector<ScreenVertex> vertices_;  // vertices of all objects
    std::vector<std::uint32_t> first_;    // block by tile and group
    std::vector<Block> blocks_;
    std::vector<BlockHead> heads_;
    std::atomic<std::uint32_t> used_{1};
    bool rolling_ = false;          // rows are of several instants
    std::optional<RowPoses> rows_;  // those instants
    float margin_px_ = 0;           // vertices may be beside their places then

    bool take(const Pose& camera, std::span<const Shown> shown);
    bool project();
    ScreenProjection projection(const Placed& placed, const InCamera& at) const;
    static InCamera in_camera(const Placed& placed, const RowPoses::At& at);
    float roll(const Placed& placed, std::span<const Vec3f> vertices_m, ScreenVertex* out) const;
    std::array<Placed::Plane, 5> planes_of(const Mat3d& camera_from_body, Vec3d origin_camera_m) const;
    bool may_show(const Placed& placed, const std::array<Vec3f, 2>& box_m) const;
    static CornersInCamera corners_m(const Placed& placed, const InCamera& at, std::uint32_t triangle);
    void set_up(std::uint32_t block, int x_px, int y_px, TriangleSetup& setup) const;
    // They ask for memory that a block of triangles needs soon: first where its corners are, then those.
    void prefetch_corners(std::uint32_t block) const;
    void prefetch_shading_points(std::uint32_t block) const;
    void fill_blocks(std::span<NearBlock> blocks, int x_px, int y_px, VisibilityTile& tile) const;
    std::size_t tile_index(int x_px, int y_px) const {
        return static_cast<std::size_t>(y_px / kVisibilityTile_px * tiles_across_ +
                                        x_px / kVisibilityTile_px);
    }
};

}  // namespace hilcam
