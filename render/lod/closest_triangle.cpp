#include "render/lod/closest_triangle.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <vector>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

struct ReleaseDevice {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice>;
using Tree = std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene>;

struct Place {
    float u, v;
};
// Returns the barycentric place in a triangle nearest to p: Ericson, Real-Time Collision Detection, 2005,
// section 5.1.5.
Place nearest_place(Vec3f p, Vec3f a, Vec3f b, Vec3f c) {
    const Vec3f ab = b - a, ac = c - a, ap = p - a;
    const float d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return {0, 0};
    const Vec3f bp = p - b;
    const float d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return {1, 0};
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return {d1 / (d1 - d3), 0};
    const Vec3f cp = p - c;
    const float d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return {0, 1};
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return {0, d2 / (d2 - d6)};
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const float w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {1 - w, w};
    }
    const float all = va + vb + vc;
    if (!(all > 0)) return {0, 0};
    return {vb / all, vc / all};
}

}  // namespace

struct ClosestTriangle::Implementation {
    const Mesh* mesh;
    Device device;
    Tree tree;

    struct Search {
        const Mesh* mesh;
        const Query* query;
        float distance = 0;  // distance of what is found
        std::optional<Found> found;
    };
    // Takes the first of equally near triangles, because the order of visits depends on the tree.
    static bool look_at(RTCPointQueryFunctionArguments* arguments) {
        Search& search = *static_cast<Search*>(arguments->userPtr);
        const Mesh& mesh = *search.mesh;
        const std::uint32_t number = arguments->primID;
        if (mesh.surface_of_triangle[number] != search.query->surface) return false;
        const auto& corners = mesh.triangles[number];
        const Vec3f a = mesh.vertices_m[corners[0]], b = mesh.vertices_m[corners[1]],
                    c = mesh.vertices_m[corners[2]];
        if (dot(cross(b - a, c - a), search.query->normal) <= 0) return false;
        const Vec3f p = search.query->place_m;
        const Place at = nearest_place(p, a, b, c);
        const float distance = length(a + at.u * (b - a) + at.v * (c - a) - p);
        if (!(distance <= search.distance)) return false;
        if (search.found && distance == search.distance && number > search.found->triangle) return false;
        search.distance = distance;
        search.found = Found{number, at.u, at.v};
        // Slightly more, so that no equally near triangle is cut off.
        constexpr float kAsNear = 1.0001f, kMin_m = 1e-12f;
        arguments->query->radius = std::min(arguments->query->radius, std::max(kAsNear * distance, kMin_m));
        return true;
    }
};

ClosestTriangle::ClosestTriangle(const Mesh& mesh)
    : implementation_(std::make_unique<Implementation>(Implementation{&mesh, {}, {}})) {
    Implementation& my = *implementation_;
    my.device.reset(rtcNewDevice(nullptr));
    HILCAM_CHECK(my.device);
    my.tree.reset(rtcNewScene(my.device.get()));
    RTCGeometry geometry = rtcNewGeometry(my.device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                             sizeof(Vec3f), mesh.vertices_m.size());
    std::copy(mesh.vertices_m.begin(), mesh.vertices_m.end(), static_cast<Vec3f*>(vertices));
    void* triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                              sizeof(mesh.triangles[0]), mesh.triangles.size());
    std::copy(mesh.triangles.begin(), mesh.triangles.end(),
              static_cast<std::array<std::uint32_t, 3>*>(triangles));
    rtcSetGeometryPointQueryFunction(geometry, Implementation::look_at);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(my.tree.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(my.tree.get());
}
ClosestTriangle::~ClosestTriangle() = default;

std::optional<ClosestTriangle::Found> ClosestTriangle::find(const Query& query) const {
    const Implementation& my = *implementation_;
    Implementation::Search search{my.mesh, &query, query.radius_m, std::nullopt};
    RTCPointQuery at{query.place_m.x, query.place_m.y, query.place_m.z, 0, query.radius_m};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(my.tree.get(), &at, &context, nullptr, &search);
    return search.found;
}

}  // namespace hilcam
