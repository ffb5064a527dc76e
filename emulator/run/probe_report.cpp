#include "emulator/run/probe_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "emulator/scenario/scene_loader.h"
#include "render/probes/probe_view.h"
#include "render/scene/surface.h"

namespace hilcam {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(Vec3f v) { return {v.x, v.y, v.z}; }

const char* word_for(ProbeMeets meets) {
    switch (meets) {
        case ProbeMeets::kNothing:
            return "nothing";
        case ProbeMeets::kProbe:
            return "probe";
        case ProbeMeets::kDark:
            return "dark";
        case ProbeMeets::kOwnSide:
            return "own_side";
        case ProbeMeets::kBuried:
            return "buried";
    }
    return "";
}

std::string surface_name(const LoadedObject& object, std::size_t surface) {
    return surface < object.surfaces.size() ? object.surfaces[surface].name : std::string();
}

Json points_json(const TransferTable& table, std::size_t number) {
    const SurfaceProbe& probe = table.probes().probes()[number];
    Json points = Json::array();
    for (std::size_t p = 0; p < SurfaceProbe::kPoints; ++p)
        points.push_back({{"position_m", vector_json(probe.point_m[p])},
                          {"normal", vector_json(unpack_normal(probe.normal[p]))},
                          {"geometric_normal", vector_json(unpack_normal(probe.geometric[p]))},
                          {"counts", table.is_live(number, p)}});
    return points;
}

Json rays_json(const TransferTable& table, std::size_t number, const LoadedObject& object) {
    Json rays = Json::array();
    for (const ProbeRay& ray : rays_of(table, number)) {
        Json entry{{"dir", vector_json(ray.dir)}, {"point", ray.point}, {"meets", word_for(ray.meets)}};
        if (ray.meets == ProbeMeets::kProbe) {
            const SurfaceProbe& met = table.probes().probes()[ray.probe];
            entry["probe"] = ray.probe;
            entry["surface"] = surface_name(object, met.surface);
            entry["position_m"] = vector_json(met.point_m[0]);
        }
        rays.push_back(std::move(entry));
    }
    return rays;
}

std::size_t object_of(const std::vector<LoadedObject>& objects, const std::string& name) {
    std::string names;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        if (objects[i].name == name) return i;
        names += (i > 0 ? ", " : "") + objects[i].name;
    }
    throw InputError("--probe " + name +
                     ": the scenario has no such object; accepted: " + (names.empty() ? "none" : names));
}

}  // namespace

std::string probe_report(const ScenarioConfig& scenario, const ProbeChoice& choice) {
    std::vector<LoadedObject> objects;
    const SpectralGrid grid(scenario.spectrum_edges_um);
    const Scene scene = load_scene(scenario, grid, Modules(), &objects);
    const std::size_t object = object_of(objects, choice.object);
    const std::shared_ptr<const TransferTable>& table = scene.objects[object].transfer;
    if (!table || table->size() == 0)
        throw InputError("--probe " + choice.object + ": no light is cached on it with quality.path_model '" +
                         scenario.quality.render.path_model + "'; accepted: an object on which it is");
    if (choice.number >= table->size())
        throw InputError("--probe " + choice.object + ' ' + std::to_string(choice.number) +
                         ": it has no such probe; accepted: 0 to " + std::to_string(table->size() - 1));
    const SurfaceProbe& probe = table->probes().probes()[choice.number];
    const Json out{{"object", choice.object},
                   {"probe", choice.number},
                   {"probes", table->size()},
                   {"cube_m", table->probes().cube_m()},
                   {"surface", surface_name(objects[object], probe.surface)},
                   {"normal", vector_json(unpack_normal(probe.mean_normal))},
                   {"points", points_json(*table, choice.number)},
                   {"directions", rays_json(*table, choice.number, objects[object])}};
    return out.dump(2) + '\n';
}

}  // namespace hilcam
