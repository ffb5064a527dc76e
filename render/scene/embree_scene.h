#pragma once
// The acceleration structure: meshes once, instances of them placed anew each frame, rays in packets of
// sixteen. The one unit that knows Embree (3 or 4).
//
// Ray space (frame_context.h): axes parallel to the world, metres, single precision. Placing an object
// subtracts its origin in double precision first, so that near things keep their digits wherever in the world
// they are. Precision: a hit's distance is good to a few 1e-7 of the distance to the object; objects many
// times farther than large (10^4 and more) lose shape. Hits of shared edges: see watertight.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "render/scene/mesh_grid.h"
#include "render/vocabulary/mesh.h"
#include "render/vocabulary/pose.h"

namespace hilcam {

inline constexpr int kPacketSize = 16;

// Sixteen rays side by side. Directions need not be unit vectors; distances are in their lengths.
struct alignas(64) RayPacket {
    std::array<float, kPacketSize> origin_x, origin_y, origin_z;
    std::array<float, kPacketSize> dir_x, dir_y, dir_z;
    std::array<float, kPacketSize> nearest, farthest;
    int count = 0;  // rays 0 .. count-1 are traced

    void set(int i, Vec3f origin, Vec3f dir, float least, float most) {
        const auto k = static_cast<std::size_t>(i);
        origin_x[k] = origin.x, origin_y[k] = origin.y, origin_z[k] = origin.z;
        dir_x[k] = dir.x, dir_y[k] = dir.y, dir_z[k] = dir.z;
        nearest[k] = least, farthest[k] = most;
    }
    Vec3f origin(std::size_t k) const { return {origin_x[k], origin_y[k], origin_z[k]}; }
    Vec3f dir(std::size_t k) const { return {dir_x[k], dir_y[k], dir_z[k]}; }
};

struct alignas(64) HitPacket {
    static constexpr std::uint32_t kMiss = ~std::uint32_t{0};
    std::array<float, kPacketSize> distance;                      // in lengths of the ray's direction
    std::array<float, kPacketSize> u, v;                          // barycentric: corner 1, corner 2
    std::array<float, kPacketSize> normal_x, normal_y, normal_z;  // geometric, in the object's axes, not unit
    std::array<std::uint32_t, kPacketSize> object;                // index of the instance, or kMiss
    std::array<std::uint32_t, kPacketSize> triangle;              // index in the object's mesh
};

// The way in which the rays of a packet run: side by side (from the camera, to the Sun) or anywhere.
enum class Coherence { kCoherent, kIncoherent };

// A mesh's shape, in the object's axes.
struct MeshView {
    std::span<const Vec3f> vertices_m;
    std::span<const std::array<std::uint32_t, 3>> triangles;
};

// A mesh with its tree, made beside a scene.
class PreparedMesh {
  public:
    PreparedMesh() = default;
    PreparedMesh(PreparedMesh&& other) noexcept
        : scene_(other.scene_), mesh_(other.mesh_), grids_(std::move(other.grids_)) {
        other.scene_ = nullptr;
    }
    PreparedMesh& operator=(PreparedMesh&&) = delete;
    ~PreparedMesh();

  private:
    friend class EmbreeScene;
    // A mesh of grids is kept as it is.
    struct Grids {
        std::vector<MeshGrid> all;
        std::vector<Vec3f> vertices_m;
        std::vector<std::array<std::uint32_t, 3>> triangles;
    };
    void* scene_ = nullptr;
    MeshView mesh_;  // the copy that the scene or the grids keep
    Grids grids_;
};

class EmbreeScene {
  public:
    // One instance per object, each with its levels of detail, the mesh itself first; builds their trees on
    // all of oneTBB's threads, of a mesh that several have one. Vertices and triangles are copied. Throws
    // InputError when memory runs out. watertight: a ray along an edge that two triangles share meets one of
    // them, always; costs a sixth.
    EmbreeScene(std::span<const std::vector<const Mesh*>> objects, bool watertight);
    ~EmbreeScene();

    // Places the objects for a frame, each at one of its levels. Loop, one thread; Embree rebuilds its small
    // top-level tree.
    void place(std::span<const Pose> objects, std::span<const std::size_t> levels, Vec3d origin_world_m);

    // Returns a mesh to take an object's place, always watertight: it is ground, and a camera straight above
    // a grid of heights looks along whole rows of its edges. Its tree is made in a quarter of the time of others', and rays through it
    // take a tenth more. Any thread, also while others trace.
    PreparedMesh prepare(const Mesh& mesh) const;
    // The same of a mesh that is nothing but grids. Its tree is made in a quarter of that time, and a hit's barycentric place is
    // good to 1e-5.
    PreparedMesh prepare(Mesh mesh, std::vector<MeshGrid> grids) const;
    // Puts it in the place of the object's first level, from the next place() on; `mesh` then holds what was
    // there. Loop, one thread.
    void adopt(std::size_t object, PreparedMesh& mesh);

    // The copy that is kept of a mesh. Any thread.
    MeshView mesh(std::size_t object, std::size_t level) const;

    // Any thread between two place(). No allocation.
    void intersect(const RayPacket& rays, Coherence coherence, HitPacket& hits) const;
    // Bit i set: something lies between nearest and farthest of ray i.
    std::uint32_t occluded(const RayPacket& rays) const;
    // The same of one object alone, its first level; rays in its own axes, from its origin. Any thread, at
    // any time but while adopt() runs.
    void intersect_with(std::size_t object, const RayPacket& rays, HitPacket& hits) const;
    std::uint32_t occluded_by(std::size_t object, const RayPacket& rays) const;

    // Keeps a copy of every packet that is traced from now on, by any thread, for measurements.
    void start_recording();
    // Stops that, and traces the copies again with nothing around them. Not for the loop.
    struct Replay {
        std::uint64_t rays = 0;
        double milliseconds = 0;
    };
    enum class Replayed { kAll, kPrimaryAndShadow };  // the latter: without the rays that continue paths
    Replay replay(Replayed which = Replayed::kAll);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace hilcam
