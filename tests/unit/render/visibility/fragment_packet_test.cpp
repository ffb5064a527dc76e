#include "render/visibility/fragment_packet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "render/shading/frame_context.h"
#include "render/shading/shading_point.h"

namespace hilcam {
namespace {

// Random triangles with smooth normals, in front of the camera, and rays through them.
struct Debris {
    Mesh mesh;
    std::vector<Vec3f> dirs, origins_m;

    Debris() {
        std::mt19937 engine(4);
        std::normal_distribution<float> any;
        for (std::uint32_t i = 0; i < 64; ++i) {
            Vec3f middle;
            for (int k = 0; k < 3; ++k) {
                mesh.vertices_m.push_back({any(engine), any(engine), 6 + any(engine)});
                mesh.normals.push_back(normalized(Vec3f{any(engine), any(engine), any(engine)}));
                middle = middle + mesh.vertices_m.back() / 3.0f;
            }
            mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
            origins_m.push_back({0.1f * any(engine), 0.1f * any(engine), 0});
            dirs.push_back(2.0f * (middle - origins_m.back()));
        }
        mesh.surfaces.resize(1);
        mesh.surface_of_triangle.resize(mesh.triangles.size());
    }
};

TEST(FragmentPacket, FindsWhatRaysFindOneByOne) {
    const Debris debris;
    const std::vector<const Mesh*> levels = {&debris.mesh};
    const Pose pose{{0.2, -0.1, 0.5}, normalized(Quat{0.9, 0.05, -0.1, 0.4})};
    EmbreeScene embree({&levels, 1}, true);
    const std::size_t level = 0;
    embree.place({&pose, 1}, {&level, 1}, {});
    const ObjectSurfaces surfaces(debris.mesh, std::vector<Material>(1),
                                  std::make_shared<const std::vector<MipTexture>>());
    const std::vector<const ObjectSurfaces*> objects = {&surfaces};
    const Mat3d m = to_matrix(pose.world_from_body);
    FrameContext frame;
    frame.objects = &objects;
    frame.world_from_body = {{to_float(m.x), to_float(m.y), to_float(m.z)}};
    int compared = 0;
    for (std::uint32_t first = 0; first < 64; first += FragmentPacket::kSize) {
        // What the first mesh's ray meets may be another triangle: of its own that each is asked for.
        RayPacket rays;
        HitPacket hits;
        FragmentPacket packet;
        rays.count = FragmentPacket::kSize;
        for (std::size_t k = 0; k < FragmentPacket::kSize; ++k) {
            const Vec3f origin = to_float(m * to_double(debris.origins_m[first + k]) + pose.position_world_m);
            const Vec3f dir = frame.world_from_body[0] * debris.dirs[first + k];
            rays.set(static_cast<int>(k), origin, dir, 0, INFINITY);
            packet.dir.set(k, dir);
            packet.origin.set(k, origin - to_float(pose.position_world_m));
        }
        embree.intersect(rays, Coherence::kIncoherent, hits);
        packet.triangle = hits.triangle;
        packet.count = FragmentPacket::kSize;
        find_surface_frames({debris.mesh.vertices_m.data(), debris.mesh.triangles.data(),
                             surfaces.triangles.data(), frame.world_from_body[0]},
                            packet);
        for (std::size_t k = 0; k < FragmentPacket::kSize; ++k) {
            ASSERT_NE(hits.object[k], HitPacket::kMiss);
            SurfaceFrame lie;
            ASSERT_TRUE(find_surface_frame(frame, hits, static_cast<int>(k), packet.dir.at(k), lie));
            EXPECT_NEAR(packet.distance[k], hits.distance[k], 2e-5f);
            EXPECT_NEAR(packet.u[k], hits.u[k], 2e-4f);
            EXPECT_NEAR(packet.v[k], hits.v[k], 2e-4f);
            EXPECT_LT(length(packet.geometric.at(k) - lie.geometric_normal), 1e-5f);
            EXPECT_LT(length(packet.normal.at(k) - lie.normal), 2e-3f);
            EXPECT_LT(length(packet.view_dir.at(k) - lie.view_dir), 1e-6f);
            EXPECT_EQ(packet.back[k] != 0, lie.back);
            ++compared;
        }
    }
    EXPECT_EQ(compared, 64);
}

}  // namespace
}  // namespace hilcam
