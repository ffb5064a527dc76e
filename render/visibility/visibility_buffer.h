#pragma once
// Finds which triangle each of sixteen samples in every pixel sees, for less than the cost of one ray per
// pixel and with the same result. Triangles are projected and sorted into tiles of the screen once per frame;
// tiles are filled when they are shaded. Lenses with distortion are affine in each tile (lens_tiles.h). See
// docs/rendering.md, "Visibility".
//
// All pixels have one instant, or each row of a rolling shutter has its own (row_poses.h, rolling_raster.h).
//
// Not supported: line scanners, fisheyes, lenses that bend much within a tile (takes()). place() returns
// false for frames with more triangles than fit into memory, and for those whose rows see fast motion; rays
// render these.
//
// Precision: places on the screen are good to a thousandth of a pixel, also for objects that are far away
// compared with their size; depth to a few 1e-7 of the distance, or of the object's size if that is smaller.
// A triangle that crosses the camera's plane is cut by exact homogeneous edges (Olano & Greer, Graphics
// Hardware 1997).

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
    // The most that a frame may contain.
    struct Capacity {
        std::size_t objects = 0, vertices = 0, triangles = 0;
        bool rows = false;  // rows may have different instants
    };
    // The largest motion from one row to the next, if rows have different instants: at the upper and lower
    // border of a row of pixels places are off by half of that [px].
    static constexpr float kMaxRowSpeed_px = 0.25f;
    static bool takes(const ImageGeometry& geometry) { return LensTiles::takes(geometry); }
    // geometry: one for which takes() is true. Owner thread.
    VisibilityBuffer(const ImageGeometry& geometry, const Capacity& capacity);

    // Changes the focal length of a lens without distortion, from the next place() on. Loop.
    void set_focal_length(double focal_length_px) {
        geometry_.focal_length_px = focal_length_px;
        lens_ = LensTiles(geometry_);
    }

    // An object as a frame shows it; what it points to must outlive the frame.
    struct Shown {
        std::uint32_t object;
        Pose pose;
        double radius_m;
        MeshView mesh;  // outlives the frame
        // Boxes of its clusters (ObjectSurfaces); clusters outside the picture are skipped. Empty: all
        // triangles are processed.
        std::span<const std::array<Vec3f, 2>> cluster_bounds_m{};
        // For each triangle, the one whose id represents it, or that it is not shown (coplanar_groups.h).
        // Empty: each has its own.
        std::span<const std::uint32_t> coplanar_groups{};
        // The part that may be visible (potentially_visible_sets.h); the rest is skipped. Null: all of it.
        const PotentiallyVisibleSet* visible = nullptr;
    };
    // Sorts the triangles of a frame. rows: the camera's motion between rows, each of which is rows_px rows
    // of the buffer; null: all rows have one instant. Returns false if there is no room for the triangles or
    // they move too fast. Loop.
    bool place(const Pose& camera, std::span<const Shown> shown, const RowMotion* rows = nullptr,
               int rows_px = 1);

    // Finds what a tile's samples see; x and y of its corner are multiples of kVisibilityTile_px. Returns
    // false if they see nothing. Loop, any thread.
    bool fill(int x_px, int y_px, VisibilityTile& tile) const;
    // Does so for all tiles in order; calls use(x_px, y_px) for each that sees something. Any thread.
    template <class Use>
    void fill_all(VisibilityTile& tile, const Use& use) const {
        for (int y = 0; y < geometry_.padded_height(); y += kVisibilityTile_px)
            for (int x = 0; x < geometry_.padded_width(); x += kVisibilityTile_px)
                if (fill(x, y, tile)) use(x, y);
    }

    // Returns the direction through a place in a pixel, as its tile has it; world axes, any length.
    Vec3d direction(int x_px, int y_px, Vec2f within_px) const;
    // Returns the camera's displacement, from its position at the frame's time to that when a row is read.
    Vec3d moved_m(int y_px) const { return rolling_ ? rows_->of_row(y_px).moved_m : Vec3d{}; }

    // The triangle that an id in a tile represents.
    struct Seen {
        const Shown* shown;
        std::uint32_t triangle;
    };
    Seen seen(std::uint32_t id) const;

  private:
    static constexpr std::size_t kGroups = 64;  // groups of triangles that are sorted in parallel
    static constexpr std::uint32_t kNoBlock = 0;

    // Up to sixteen triangles of an object that a tile may show.
    struct alignas(64) Block {
        std::array<std::uint32_t, kTrianglesAtOnce> triangles;
    };
    struct BlockHead {
        std::uint32_t next = kNoBlock;
        std::uint32_t placed = 0;  // index of the object
        std::uint16_t count = 0;
        bool cut = false;   // a single triangle that is not wholly on the screen
        float nearest = 0;  // greatest depth of all
    };
    // A block to be filled into a tile. `order` is that of the groups, because the numbers of blocks vary
    // from run to run.
    struct NearBlock {
        float nearest;
        std::uint32_t order, block;
    };
    struct Placed {
        Shown shown;
        // The triangles that are drawn, and for each the id of the one it represents; empty: its own.
        MeshView drawn;
        std::span<const std::uint32_t> ids;
        std::size_t first_vertex, first_drawn;
        std::size_t first_triangle;  // id of the whole mesh's first triangle
        Mat3d world_from_body;
        Vec3d offset_m;      // from the camera, world axes
        InCamera in_camera;  // at the frame's time
        ScreenProjection projection;
        // The picture's edges and the camera's plane in body axes: a place is inside if along * place +
        // offset_m >= 0.
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
