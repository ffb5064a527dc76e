#include "render/scene/shown_object.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/lod/coverage_map_finder.h"
#include "render/lod/triangle_order.h"
#include "render/scene/coplanar_groups.h"

namespace hilcam {
namespace {

// Widens the lobes of facets by the slopes that a level has flattened, in quadrature.
std::vector<Material> widened(std::vector<Material> materials, const std::vector<float>& flattened_alpha) {
    for (std::size_t i = 0; i < materials.size(); ++i)
        if (materials[i].has_facets() && materials[i].ggx_alpha > 0 && flattened_alpha[i] > 0)
            materials[i].ggx_alpha = std::min(1.0f, std::hypot(materials[i].ggx_alpha, flattened_alpha[i]));
    return materials;
}

// Neighbours in the mesh's order, which are close together, share a box.
std::vector<std::array<Vec3f, 2>> bounds_of(const ObjectSurfaces& mesh) {
    constexpr std::size_t kMax = 512;  // a frame looks at all of them
    const auto& clusters = mesh.cluster_bounds_m;
    const std::size_t together = (clusters.size() + kMax - 1) / kMax;
    std::vector<std::array<Vec3f, 2>> out;
    for (std::size_t i = 0; i < clusters.size(); ++i) {
        if (i % together == 0) out.push_back(clusters[i]);
        for (const Vec3f corner : clusters[i]) grow(out.back(), corner);
    }
    return out;
}

// Levels with smaller errors, relative to the object's size, have no coverage maps, because small panels
// would have too many texels. Those of a satellite with wings from 20 to 40 m have larger errors
// (docs/decisions.md#coverage-maps-of-flat-parts).
constexpr double kFinestCoverageMap = 1.0 / 65536;

}  // namespace

double ShownObject::distance_m(Vec3d from_m) const {
    double nearest = std::numeric_limits<double>::infinity();  // squared
    for (const auto& [low, high] : bounds_m) {
        const Vec3d least = to_double(low), most = to_double(high);
        const Vec3d way{std::max({least.x - from_m.x, from_m.x - most.x, 0.0}),
                        std::max({least.y - from_m.y, from_m.y - most.y, 0.0}),
                        std::max({least.z - from_m.z, from_m.z - most.z, 0.0})};
        nearest = std::min(nearest, dot(way, way));
    }
    return std::sqrt(nearest);
}

std::vector<std::vector<const Mesh*>> ordered_meshes(Scene& scene) {
    std::vector<std::vector<const Mesh*>> objects;
    for (SceneObject& object : scene.objects) {
        if (object.like) {
            objects.push_back(objects[*object.like]);
            continue;
        }
        std::vector<const Mesh*>& meshes = objects.emplace_back();
        order_triangles(object.mesh);
        meshes.push_back(&object.mesh);
        for (MeshLevel& level : object.levels) meshes.push_back(&level.mesh);
    }
    return objects;
}

std::vector<ShownObject> shown_objects(Scene& scene) {
    std::vector<ShownObject> objects;
    for (SceneObject& object : scene.objects) {
        if (object.like) {
            objects.push_back(objects[*object.like]);
            objects.back().name = object.name;
            objects.back().turn_rate_rad_s = object.turn_rate_rad_s;
            continue;
        }
        ShownObject& out = objects.emplace_back();
        out.name = object.name;
        out.transfer = std::move(object.transfer);
        out.turn_rate_rad_s = object.turn_rate_rad_s;
        std::vector<MipTexture> pictures;
        for (Texture& texture : object.mesh.textures) pictures.emplace_back(std::move(texture));
        const auto textures = std::make_shared<const std::vector<MipTexture>>(std::move(pictures));
        auto finest = std::make_shared<ObjectSurfaces>(object.mesh, object.materials, textures);
        find_coplanar_groups(object.mesh, *finest);
        out.bounds_m = bounds_of(*finest);
        out.levels.push_back(std::move(finest));
        out.error_m.push_back(0);
        std::shared_ptr<const std::vector<CoverageMap>> coverage_maps;
        for (MeshLevel& level : object.levels) {
            auto surfaces = std::make_shared<ObjectSurfaces>(
                level.mesh, widened(object.materials, level.flattened_alpha), textures);
            surfaces->flattened_alpha = level.flattened_alpha;
            surfaces->lod_normals = std::move(level.lod_normals);
            find_coplanar_groups(level.mesh, *surfaces);
            if (!coverage_maps && level.error_m >= kFinestCoverageMap * 2 * surfaces->radius_m)
                coverage_maps = std::make_shared<const std::vector<CoverageMap>>(find_coverage_maps(
                    level.mesh, may_be_in_coverage_maps(level.mesh, *surfaces), level.error_m));
            attach_coverage_maps(coverage_maps, level.mesh, level.error_m, *surfaces);
            out.levels.push_back(std::move(surfaces));
            out.error_m.push_back(level.error_m);
        }
    }
    scene.objects.clear();
    return objects;
}

}  // namespace hilcam
