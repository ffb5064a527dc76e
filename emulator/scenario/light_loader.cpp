#include "emulator/scenario/light_loader.h"

#include <algorithm>
#include <cmath>

#include "emulator/progress/progress.h"
#include "emulator/progress/user_cache.h"
#include "io/cache/transfer_cache.h"
#include "render/vocabulary/stopwatch.h"

namespace hilcam {
namespace {

bool wants_indirect_cache(const ScenarioConfig& scenario) {
    const std::vector<RenderQuality> lower = lower_levels(scenario);
    const auto keeps = [](const RenderQuality& q) { return q.path_model == "cached"; };
    return keeps(scenario.quality.render) || std::any_of(lower.begin(), lower.end(), keeps);
}

double area_of(const Mesh& mesh) {
    double twice = 0;
    for (const auto& t : mesh.triangles) {
        const Vec3f a = mesh.vertices_m[t[0]];
        twice += static_cast<double>(length(cross(mesh.vertices_m[t[1]] - a, mesh.vertices_m[t[2]] - a)));
    }
    return std::isfinite(twice) ? 0.5 * twice : 0;
}

// Makes an order without the mesh, which is copied only if the table is to be made later.
TableOrder order_of(const SceneObject& object, float scale, std::size_t nodes,
                    const ScenarioConfig& scenario) {
    TableOrder order;
    order.name = object.name;
    order.scale = scale;
    for (const Material& material : object.materials) order.glass.push_back(material.transmits());
    order.settings = {static_cast<int>(scenario.quality.render.probe_directions), nodes,
                      !scenario.lamps.empty() || models_of(scenario).radiance != "reflected"};
    return order;
}

void load_table(std::vector<SceneObject>& objects, std::size_t i, TableOrder order, const Cache& cache,
                LightLoading& light) {
    SceneObject& object = objects[i];
    const TableSource source{object.mesh, order.glass, order.settings, order.scale};
    object.transfer = find_transfer(source, cache);
    if (object.transfer) {
        ++light.found;
    } else if (!light.later) {
        Progress progress("light kept on " + object.name, 1);
        object.transfer = cached_transfer(source, cache, [&progress](double share) { progress.done(share); });
        ++light.made;
    } else {
        order.mesh = object.mesh;
        for (std::size_t k = i; k < objects.size(); ++k)
            if (k == i || objects[k].like == i) order.objects.push_back(k);
        light.orders.push_back(std::move(order));
    }
}

// Rounds a size to a power of two. Objects that become slightly larger or smaller then keep their share of
// probes, and so their table; a scene that is scaled as a whole does so exactly.
double rough(float scale) { return std::exp2(std::round(std::log2(static_cast<double>(scale)))); }

}  // namespace

// Divides the surface probes among the objects by area; each object has some.
void load_tables(Scene& scene, const std::vector<float>& scales, const ScenarioConfig& scenario,
                 LightLoading& light) {
    if (!wants_indirect_cache(scenario)) return;
    constexpr double kMin = 1000;
    const Stopwatch watch;
    std::vector<SceneObject>& objects = scene.objects;
    std::vector<double> area_m2;
    double all_m2 = 0;
    for (std::size_t i = 0; i < objects.size(); ++i)
        all_m2 += area_m2.emplace_back(objects[i].like
                                           ? area_m2[*objects[i].like]
                                           : rough(scales[i]) * rough(scales[i]) * area_of(objects[i].mesh));
    const Cache cache = user_cache(!scenario.is_used_once);
    for (std::size_t i = 0; i < objects.size(); ++i) {
        if (objects[i].like || !(area_m2[i] > 0)) continue;
        const auto most = static_cast<double>(scenario.quality.render.probes);
        const double nodes = std::max(std::min(kMin, most), most * area_m2[i] / all_m2);
        load_table(objects, i, order_of(objects[i], scales[i], static_cast<std::size_t>(nodes), scenario),
                   cache, light);
    }
    scene.light_later = !light.orders.empty();
    light.seconds = watch.seconds();
}

std::shared_ptr<const TransferTable> make_table(const TableOrder& order, const WorkWatcher& watcher) {
    return cached_transfer({order.mesh, order.glass, order.settings, order.scale}, user_cache(), watcher);
}

}  // namespace hilcam
