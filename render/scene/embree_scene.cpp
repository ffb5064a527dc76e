#include "render/scene/embree_scene.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <tbb/blocked_range.h>
#include <tbb/concurrent_vector.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "render/vocabulary/check.h"
#include "render/vocabulary/stopwatch.h"

namespace hilcam {
namespace {

// Occlusion never uses Embree's coherent path. Built by a GCC before 14, such as Debian 12's, that path does
// not end on processors with AVX-512, because the compiler leaves garbage above a 16-bit mask (Embree pull
// request 574, 2025).
constexpr Coherence kOcclusion = Coherence::kIncoherent;
// Trees with spatial splits take longer to build and suit long thin triangles, as simplified meshes have.
constexpr std::size_t kSpatialSplits = 1000000;

RTCBuildQuality quality_for(const Mesh& mesh) {
    return mesh.triangles.size() < kSpatialSplits ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
}

// The two versions differ in how a query takes its options.
#if RTC_VERSION_MAJOR >= 4
RTCRayQueryFlags flags_of(Coherence c) {
    return c == Coherence::kCoherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
}
void intersect_16(const int* valid, RTCScene scene, Coherence coherence, RTCRayHit16& rays) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = flags_of(coherence);
    rtcIntersect16(valid, scene, &rays, &arguments);
}
void occluded_16(const int* valid, RTCScene scene, RTCRay16& rays) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = flags_of(kOcclusion);
    rtcOccluded16(valid, scene, &rays, &arguments);
}
#else
RTCIntersectContext context_of(Coherence c) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = c == Coherence::kCoherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                              : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return context;
}
void intersect_16(const int* valid, RTCScene scene, Coherence coherence, RTCRayHit16& rays) {
    RTCIntersectContext context = context_of(coherence);
    rtcIntersect16(valid, scene, &context, &rays);
}
void occluded_16(const int* valid, RTCScene scene, RTCRay16& rays) {
    RTCIntersectContext context = context_of(kOcclusion);
    rtcOccluded16(valid, scene, &context, &rays);
}
#endif

// All ones for the rays that exist, zero for the rest of the packet.
void set_valid(int count, int* valid) {
    for (int i = 0; i < kPacketSize; ++i) valid[i] = i < count ? -1 : 0;
}

// Makes unused rays harmless: on processors without AVX-512, Embree splits a packet of sixteen and looks at
// all of them, whatever the mask says.
void blank_ray(int i, RTCRay16& rays) {
    rays.org_x[i] = rays.org_y[i] = rays.org_z[i] = 0;
    rays.dir_x[i] = rays.dir_y[i] = 0, rays.dir_z[i] = 1;
    rays.tnear[i] = 0, rays.tfar[i] = -std::numeric_limits<float>::infinity();
}

// Embree ends the program at a ray that starts or points beyond the root of the largest float, or is not
// finite. Frames make no such rays (motion_bounds.h); if there is one nevertheless, it meets nothing.
void stop_wild_rays(RTCRay16& rays) {
    constexpr float kMax = 1.8e18f;
    const auto wild = [&rays](int i) {
        const auto out = [](float v) { return static_cast<int>(!(std::abs(v) < kMax)); };
        return out(rays.org_x[i]) | out(rays.org_y[i]) | out(rays.org_z[i]) | out(rays.dir_x[i]) |
               out(rays.dir_y[i]) | out(rays.dir_z[i]) | static_cast<int>(std::isnan(rays.tnear[i])) |
               static_cast<int>(std::isnan(rays.tfar[i]));
    };
    int any = 0;
    for (int i = 0; i < kPacketSize; ++i) any |= wild(i);
    if (any == 0) return;
    for (int i = 0; i < kPacketSize; ++i)
        if (wild(i) != 0)
            blank_ray(i, rays), rays.tnear[i] = 1, rays.tfar[i] = 0;  // not -infinity, which is "blocked"
}

void copy_rays(const RayPacket& from, RTCRay16& to) {
    static_assert(sizeof(from.origin_x) == sizeof(to.org_x));
    std::memcpy(to.org_x, from.origin_x.data(), sizeof(to.org_x));
    std::memcpy(to.org_y, from.origin_y.data(), sizeof(to.org_y));
    std::memcpy(to.org_z, from.origin_z.data(), sizeof(to.org_z));
    std::memcpy(to.dir_x, from.dir_x.data(), sizeof(to.dir_x));
    std::memcpy(to.dir_y, from.dir_y.data(), sizeof(to.dir_y));
    std::memcpy(to.dir_z, from.dir_z.data(), sizeof(to.dir_z));
    std::memcpy(to.tnear, from.nearest.data(), sizeof(to.tnear));
    std::memcpy(to.tfar, from.farthest.data(), sizeof(to.tfar));
    std::memset(to.time, 0, sizeof(to.time));
    std::memset(to.flags, 0, sizeof(to.flags));
    std::memset(to.mask, 0xFF, sizeof(to.mask));
    for (int i = from.count; i < kPacketSize; ++i) blank_ray(i, to);
    stop_wild_rays(to);
}

std::uint32_t blocked_in(RTCScene scene, const RayPacket& rays) {
    alignas(64) int valid[kPacketSize];
    set_valid(rays.count, valid);
    RTCRay16 query;
    copy_rays(rays, query);
    occluded_16(valid, scene, query);
    // Embree marks a blocked ray by tfar = -infinity.
    std::uint32_t blocked = 0;
    for (int i = 0; i < rays.count; ++i) blocked |= (query.tfar[i] < 0 ? 1u : 0u) << i;
    return blocked;
}

void met_in(RTCScene scene, const RayPacket& rays, Coherence coherence, RTCRayHit16& query, HitPacket& hits) {
    alignas(64) int valid[kPacketSize];
    set_valid(rays.count, valid);
    copy_rays(rays, query.ray);
    std::memset(query.hit.geomID, 0xFF, sizeof(query.hit.geomID));
    std::memset(query.hit.instID[0], 0xFF, sizeof(query.hit.instID[0]));
    intersect_16(valid, scene, coherence, query);
    static_assert(HitPacket::kMiss == RTC_INVALID_GEOMETRY_ID);
    std::memcpy(hits.distance.data(), query.ray.tfar, sizeof(query.ray.tfar));
    std::memcpy(hits.u.data(), query.hit.u, sizeof(query.hit.u));
    std::memcpy(hits.v.data(), query.hit.v, sizeof(query.hit.v));
    std::memcpy(hits.normal_x.data(), query.hit.Ng_x, sizeof(query.hit.Ng_x));
    std::memcpy(hits.normal_y.data(), query.hit.Ng_y, sizeof(query.hit.Ng_y));
    std::memcpy(hits.normal_z.data(), query.hit.Ng_z, sizeof(query.hit.Ng_z));
    std::memcpy(hits.triangle.data(), query.hit.primID, sizeof(query.hit.primID));
}

// The copy of a mesh that its scene keeps.
MeshView view_of(RTCScene scene, const Mesh& mesh) {
    const RTCGeometry geometry = rtcGetGeometry(scene, 0);
    const void* vertices = rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
    const void* triangles = rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_INDEX, 0);
    return {{static_cast<const Vec3f*>(vertices), mesh.vertices_m.size()},
            {static_cast<const std::array<std::uint32_t, 3>*>(triangles), mesh.triangles.size()}};
}

}  // namespace

// Marks an object whose instance needs its scene set again.
constexpr std::size_t kNoLevel = std::numeric_limits<std::size_t>::max();

struct EmbreeScene::Implementation {
    RTCDevice device = nullptr;
    RTCScene top = nullptr;
    std::vector<std::vector<RTCScene>> levels;  // per object
    std::vector<std::vector<MeshView>> meshes;  // their meshes, where Embree keeps them
    std::vector<std::size_t> shown;             // level of each
    std::vector<std::uint8_t> absent;           // per object: it is not in this frame
    std::vector<RTCGeometry> instances;
    std::vector<PreparedMesh::Grids> grids;  // per object; empty for a mesh of triangles

    struct Recorded {
        RayPacket rays;
        Coherence coherence;
        bool occlusion;
    };
    std::unique_ptr<tbb::concurrent_vector<Recorded>> recorded;

    ~Implementation() {
        for (RTCGeometry geometry : instances) rtcReleaseGeometry(geometry);
        for (const std::vector<RTCScene>& scenes : levels)
            for (RTCScene scene : scenes) rtcReleaseScene(scene);
        if (top) rtcReleaseScene(top);
        if (device) rtcReleaseDevice(device);
    }
    void require_no_error(const char* doing) const {
        const RTCError error = rtcGetDeviceError(device);
        if (error == RTC_ERROR_OUT_OF_MEMORY)
            throw InputError(std::string("out of memory while ") + doing +
                             "; use a mesh with fewer triangles");
        if (error != RTC_ERROR_NONE)
            throw DeviceError(std::string("Embree reports error ") + std::to_string(static_cast<int>(error)) +
                              " while " + doing);
    }
    RTCScene build(const Mesh& mesh, bool without_gaps, RTCBuildQuality quality) const {
        RTCScene scene = rtcNewScene(device);
        if (without_gaps) rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(scene, quality);
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                 sizeof(Vec3f), mesh.vertices_m.size());
        void* triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                  3 * sizeof(std::uint32_t), mesh.triangles.size());
        require_no_error("copying a mesh");
        // Not memcpy: a mesh without a triangle has no memory to copy from.
        std::copy_n(mesh.vertices_m.data(), mesh.vertices_m.size(), static_cast<Vec3f*>(vertices));
        std::copy_n(mesh.triangles.data(), mesh.triangles.size(),
                    static_cast<std::array<std::uint32_t, 3>*>(triangles));
        finish(scene, geometry, quality);
        return scene;
    }
    // Embree reads sixteen bytes of the last vertex: one more than the grids have.
    RTCScene build(const PreparedMesh::Grids& from) const {
        RTCScene scene = rtcNewScene(device);
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_GRID);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   from.vertices_m.data(), 0, sizeof(Vec3f), from.vertices_m.size() - 1);
        void* all = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_GRID, 0, RTC_FORMAT_GRID,
                                            sizeof(RTCGrid), from.all.size());
        require_no_error("copying a mesh");
        std::transform(from.all.begin(), from.all.end(), static_cast<RTCGrid*>(all), [](const MeshGrid& g) {
            const auto side = static_cast<std::uint16_t>(MeshGrid::side(g.quads));
            return RTCGrid{g.first_vertex, side, side, side};
        });
        finish(scene, geometry, RTC_BUILD_QUALITY_MEDIUM);
        return scene;
    }
    void finish(RTCScene scene, RTCGeometry geometry, RTCBuildQuality quality) const {
        rtcSetGeometryBuildQuality(geometry, quality);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene);
        require_no_error("building a mesh's tree");
    }
    // Finds the object's triangle and the place in it from Embree's hit on a grid.
    void name_triangle(std::size_t object, HitPacket& hits, std::size_t i) const {
        const std::vector<MeshGrid>& all = grids[object].all;
        if (all.empty()) return;
        const MeshGrid::Place at = all[hits.triangle[i]].place_at(hits.u[i], hits.v[i]);
        hits.triangle[i] = at.triangle, hits.u[i] = at.u, hits.v[i] = at.v;
    }
};

EmbreeScene::EmbreeScene(std::span<const std::vector<const Mesh*>> objects, bool watertight)
    : implementation_(std::make_unique<Implementation>()) {
    Implementation& my = *implementation_;
    my.device = rtcNewDevice(nullptr);
    if (!my.device) throw DeviceError("Embree cannot start on this processor; it needs SSE2 at least");
    my.top = rtcNewScene(my.device);
    rtcSetSceneFlags(my.top,
                     watertight ? RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_DYNAMIC);
    rtcSetSceneBuildQuality(my.top, RTC_BUILD_QUALITY_LOW);
    std::map<const Mesh*, RTCScene> built;
    for (const std::vector<const Mesh*>& meshes : objects) {
        std::vector<RTCScene>& scenes = my.levels.emplace_back();
        std::vector<MeshView>& views = my.meshes.emplace_back();
        for (const Mesh* mesh : meshes) {
            RTCScene& scene = built[mesh];
            if (scene)
                rtcRetainScene(scene);
            else
                scene = my.build(*mesh, watertight, quality_for(*mesh));
            scenes.push_back(scene);
            views.push_back(view_of(scene, *mesh));
        }
        my.shown.push_back(0);
        my.absent.push_back(0);
        my.grids.emplace_back();
        RTCGeometry instance = rtcNewGeometry(my.device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(instance, scenes.front());
        rtcSetGeometryTimeStepCount(instance, 1);
        rtcAttachGeometryByID(my.top, instance, static_cast<unsigned>(my.instances.size()));
        my.instances.push_back(instance);
    }
}

EmbreeScene::~EmbreeScene() = default;

void EmbreeScene::place(std::span<const Pose> objects, std::span<const std::size_t> levels,
                        Vec3d origin_world_m) {
    Implementation& my = *implementation_;
    HILCAM_CHECK(objects.size() == my.instances.size() && levels.size() == objects.size());
    for (std::size_t i = 0; i < objects.size(); ++i) {
        // An object with a position that is not finite is left out.
        const bool absent = !is_finite(objects[i].position_world_m);
        if (absent != (my.absent[i] != 0)) (absent ? rtcDisableGeometry : rtcEnableGeometry)(my.instances[i]);
        my.absent[i] = absent;
        if (absent) continue;
        if (my.shown[i] != levels[i])
            rtcSetGeometryInstancedScene(my.instances[i], my.levels[i][my.shown[i] = levels[i]]);
        const Mat3d r = to_matrix(objects[i].world_from_body);
        // The only narrowing of the world, after the camera was subtracted.
        const Vec3f t = to_float(objects[i].position_world_m - origin_world_m);
        const Vec3f rx = to_float(r.x), ry = to_float(r.y), rz = to_float(r.z);
        const float columns[12] = {rx.x, ry.x, rz.x, rx.y, ry.y, rz.y, rx.z, ry.z, rz.z, t.x, t.y, t.z};
        rtcSetGeometryTransform(my.instances[i], 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
        rtcCommitGeometry(my.instances[i]);
    }
    rtcCommitScene(my.top);
}

PreparedMesh::~PreparedMesh() {
    if (scene_) rtcReleaseScene(static_cast<RTCScene>(scene_));
}

PreparedMesh EmbreeScene::prepare(const Mesh& mesh) const {
    PreparedMesh out;
    const RTCScene scene = implementation_->build(mesh, true, RTC_BUILD_QUALITY_LOW);
    out.scene_ = scene, out.mesh_ = view_of(scene, mesh);
    return out;
}

PreparedMesh EmbreeScene::prepare(Mesh mesh, std::vector<MeshGrid> grids) const {
    PreparedMesh out;
    mesh.vertices_m.emplace_back();
    out.grids_ = {std::move(grids), std::move(mesh.vertices_m), std::move(mesh.triangles)};
    out.mesh_ = {std::span(out.grids_.vertices_m).first(out.grids_.vertices_m.size() - 1),
                 out.grids_.triangles};
    out.scene_ = implementation_->build(out.grids_);
    return out;
}

void EmbreeScene::adopt(std::size_t object, PreparedMesh& mesh) {
    RTCScene& first = implementation_->levels[object].front();
    void* const replaced = first;
    first = static_cast<RTCScene>(mesh.scene_);
    mesh.scene_ = replaced;
    std::swap(implementation_->meshes[object].front(), mesh.mesh_);
    std::swap(implementation_->grids[object], mesh.grids_);
    implementation_->shown[object] = kNoLevel;
}

MeshView EmbreeScene::mesh(std::size_t object, std::size_t level) const {
    return implementation_->meshes[object][level];
}

void EmbreeScene::intersect(const RayPacket& rays, Coherence coherence, HitPacket& hits) const {
    if (implementation_->recorded) implementation_->recorded->push_back({rays, coherence, false});
    RTCRayHit16 query;
    met_in(implementation_->top, rays, coherence, query, hits);
    for (std::size_t i = 0; i < kPacketSize; ++i) {
        const bool met = query.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
        hits.object[i] = met ? query.hit.instID[0][i] : HitPacket::kMiss;
        if (met) implementation_->name_triangle(hits.object[i], hits, i);
    }
}

void EmbreeScene::intersect_with(std::size_t object, const RayPacket& rays, HitPacket& hits) const {
    RTCRayHit16 query;
    met_in(implementation_->levels[object].front(), rays, Coherence::kIncoherent, query, hits);
    for (std::size_t i = 0; i < kPacketSize; ++i) {
        const bool met = query.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
        hits.object[i] = met ? static_cast<std::uint32_t>(object) : HitPacket::kMiss;
        if (met) implementation_->name_triangle(object, hits, i);
    }
}

std::uint32_t EmbreeScene::occluded(const RayPacket& rays) const {
    if (implementation_->recorded) implementation_->recorded->push_back({rays, kOcclusion, true});
    return blocked_in(implementation_->top, rays);
}

std::uint32_t EmbreeScene::occluded_by(std::size_t object, const RayPacket& rays) const {
    return blocked_in(implementation_->levels[object].front(), rays);
}

void EmbreeScene::start_recording() {
    implementation_->recorded = std::make_unique<tbb::concurrent_vector<Implementation::Recorded>>();
}

EmbreeScene::Replay EmbreeScene::replay(Replayed which) {
    const auto recorded = std::move(implementation_->recorded);
    std::vector<Implementation::Recorded> packets;
    for (const Implementation::Recorded& packet : *recorded)
        if (which == Replayed::kAll || packet.occlusion || packet.coherence == Coherence::kCoherent)
            packets.push_back(packet);
    Replay out;
    for (const Implementation::Recorded& packet : packets)
        out.rays += static_cast<std::uint64_t>(packet.rays.count);
    const Stopwatch watch;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, packets.size(), 64),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          HitPacket hits;
                          for (std::size_t i = range.begin(); i < range.end(); ++i) {
                              const Implementation::Recorded& packet = packets[i];
                              if (packet.occlusion)
                                  occluded(packet.rays);
                              else
                                  intersect(packet.rays, packet.coherence, hits);
                          }
                      });
    out.milliseconds = watch.ms();
    return out;
}

}  // namespace hilcam
