#pragma once
// The acceleration structure: meshes are built once, their instances are placed anew in each frame, and rays
// are traced in packets of sixteen. Its source is the only file that uses Embree (3 or 4).
//
// Ray space (frame_context.h) has axes parallel to the world, metres, single precision. An object's origin is
// subtracted in double precision first, so near objects keep full precision anywhere in the world. A hit's
// distance is good to a few 1e-7 of the distance to the object; objects 10^4 or more times farther away than
// they are large lose their shape. For hits on shared edges see `watertight`.

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

// Sixteen rays side by side. Directions need not be unit vectors; distances are in units of their length.
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
    std::array<float, kPacketSize> distance;  // in units of the direction's length
    std::array<float, kPacketSize> u, v;      // barycentric: corner 1, corner 2
    // Geometric normal in the object's axes, not unit.
    std::array<float, kPacketSize> normal_x, normal_y, normal_z;
    std::array<std::uint32_t, kPacketSize> object;    // index of the instance, or kMiss
    std::array<std::uint32_t, kPacketSize> triangle;  // index in the object's mesh
};

// The rays of a packet are either similar (from the camera, to the Sun) or arbitrary.
enum class Coherence { kCoherent, kIncoherent };

// The shape of a mesh, in the object's axes.
struct MeshView {
    std::span<const Vec3f> vertices_m;
    std::span<const std::array<std::uint32_t, 3>> triangles;
};

// A mesh with its tree, built outside a scene.
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
    // Embree reads the data of a grid mesh in place, so it is kept here.
    struct Grids {
        std::vector<MeshGrid> all;
        std::vector<Vec3f> vertices_m;
        std::vector<std::array<std::uint32_t, 3>> triangles;
    };
    void* scene_ = nullptr;
    MeshView mesh_;  // copy that the scene or the grids keep
    Grids grids_;
};

class EmbreeScene {
  public:
    // Makes one instance for each object from its levels of detail, the full mesh first, and builds their
    // trees on all of oneTBB's threads; objects that share a mesh share its tree. Vertices and triangles are
    // copied. Throws InputError if memory runs out. watertight: a ray along an edge between two triangles
    // always hits one of them; costs a sixth.
    EmbreeScene(std::span<const std::vector<const Mesh*>> objects, bool watertight);
    ~EmbreeScene();

    // Places the objects of a frame, each at one of its levels. Embree rebuilds its small top-level tree.
    // Loop, one thread.
    void place(std::span<const Pose> objects, std::span<const std::size_t> levels, Vec3d origin_world_m);

    // Builds a mesh that can replace an object's. It is ground, so it is always watertight: a camera straight
    // above a grid of heights looks along whole rows of its edges. Its tree is built in a quarter of the
    // usual time, and rays through it take a tenth longer. Any thread, also while others trace.
    PreparedMesh prepare(const Mesh& mesh) const;
    // Builds a mesh of nothing but grids. That takes a quarter of the time again, and barycentric coordinates
    // of hits are good to 1e-5.
    PreparedMesh prepare(Mesh mesh, std::vector<MeshGrid> grids) const;
    // Replaces the object's first level by `mesh` from the next place() on; `mesh` then holds the old one.
    // Loop, one thread.
    void adopt(std::size_t object, PreparedMesh& mesh);

    // Returns the scene's copy of a mesh. Any thread.
    MeshView mesh(std::size_t object, std::size_t level) const;

    // Finds the first hit of each ray. Any thread, between two calls of place(). No allocation.
    void intersect(const RayPacket& rays, Coherence coherence, HitPacket& hits) const;
    // Returns a word in which bit i is set if something is between nearest and farthest of ray i.
    std::uint32_t occluded(const RayPacket& rays) const;
    // The same for one object alone, at its first level, with rays in its own axes. Any thread, at any time
    // except during adopt().
    void intersect_with(std::size_t object, const RayPacket& rays, HitPacket& hits) const;
    std::uint32_t occluded_by(std::size_t object, const RayPacket& rays) const;

    // Starts to copy every packet that any thread traces, for measurements.
    void start_recording();
    // Stops copying, and traces the copies again with nothing else running. Not for the loop.
    struct Replay {
        std::uint64_t rays = 0;
        double milliseconds = 0;
    };
    // kPrimaryAndShadow: without the rays that continue paths
    enum class Replayed { kAll, kPrimaryAndShadow };
    Replay replay(Replayed which = Replayed::kAll);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace hilcam
