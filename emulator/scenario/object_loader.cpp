#include "emulator/scenario/object_loader.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "emulator/progress/progress.h"
#include "emulator/progress/user_cache.h"
#include "emulator/scenario/loaded_for.h"
#include "emulator/scenario/scenario_listing.h"
#include "io/cache/generated_mesh.h"
#include "io/cache/level_cache.h"
#include "io/files/brdf_file.h"
#include "io/meshes/albedo_file.h"
#include "io/meshes/mesh_file.h"
#include "render/brdf/brdf_table.h"
#include "render/scene/brdf.h"
#include "render/sky/motion_bounds.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {

namespace {

std::vector<std::string> arguments_of(const GeneratedMeshConfig& g) {
    std::string angle = std::to_string(g.wing_angle_deg);
    angle.resize(angle.find('.') + 3);
    return {"--triangles", std::to_string(g.triangles), "--seed", std::to_string(g.seed),
            "--wing-angle-deg=" + angle};
}

// Returns the file of an object's mesh, generated if necessary.
HeldFile mesh_file_of(const ObjectConfig& object, const Cache& cache) {
    if (object.has_mesh) return {object.mesh, {}, {}};
    return generated_mesh(object.generate.value().program, arguments_of(*object.generate), cache);
}

}  // namespace

std::string mesh_name_of(const ObjectConfig& object) {
    if (object.has_mesh) return object.mesh.string();
    return generated_mesh_name(object.generate.value().program, arguments_of(*object.generate));
}

Material load_material(const MaterialConfig& m, const SpectralGrid& grid) {
    return make_material(
        m, grid, m.table.empty() ? nullptr : std::make_shared<const BrdfTable>(read_brdf(m.table, grid)));
}

namespace {

// Returns the temperature of a surface [K]: its rule's, its material's, or the object's.
double temperature_k(const SurfaceConfig* rule, const ObjectConfig& object) {
    if (rule && rule->has_temperature) return rule->temperature_k;
    if (rule && rule->material.temperature_k > 0) return rule->material.temperature_k;
    return object.temperature_k;
}

std::vector<Material> load_materials(const Mesh& mesh, const ObjectConfig& object, const SpectralGrid& grid) {
    std::vector<Material> materials;
    for (const MeshSurface& surface : mesh.surfaces) {
        const SurfaceConfig* rule = find_surface(object.materials.surfaces, surface.name);
        if (rule) {
            materials.push_back(load_material(rule->material, grid));
            materials.back().texture = surface.base_color_texture;
        } else {
            materials.push_back(make_material(surface, grid));
        }
        set_temperature(materials.back(), grid, temperature_k(rule, object));
    }
    return materials;
}

template <class F>
Vec3d by_component(Vec3d a, Vec3d b, const F& f) {
    return {f(a.x, b.x), f(a.y, b.y), f(a.z, b.z)};
}

// Adds a mesh at its scale, with its materials, to what was found of its object.
void tell(const Mesh& mesh, float scale, const std::vector<Material>& materials, const ObjectConfig& config,
          const SpectralGrid& grid, LoadedObject& out) {
    const bool first = out.surfaces.empty();
    if (first) out.left_out = mesh.left_out;
    if (first)
        for (std::size_t i = 0; i < mesh.surfaces.size(); ++i) {
            const SurfaceConfig* rule = find_surface(config.materials.surfaces, mesh.surfaces[i].name);
            out.surfaces.push_back({mesh.surfaces[i].name, 0, 0, rule ? rule->name : "",
                                    reflectance_of(materials[i], grid), materials[i].emission.mean()});
        }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        std::array<Vec3d, 3> corner;
        for (std::size_t k = 0; k < 3; ++k) {
            corner[k] = to_double(scale * mesh.vertices_m[mesh.triangles[i][k]]);
            if (out.triangles == 0 && k == 0) out.min_m = out.max_m = corner[k];
            out.min_m = by_component(out.min_m, corner[k], [](double a, double b) { return std::min(a, b); });
            out.max_m = by_component(out.max_m, corner[k], [](double a, double b) { return std::max(a, b); });
        }
        LoadedSurface& surface = out.surfaces[mesh.surface_of_triangle[i]];
        ++surface.triangles, ++out.triangles;
        surface.area_m2 += 0.5 * length(cross(corner[1] - corner[0], corner[2] - corner[0]));
    }
    if (!first) return;
    for (const SurfaceConfig& rule : config.materials.surfaces)
        if (std::none_of(out.surfaces.begin(), out.surfaces.end(),
                         [&](const LoadedSurface& surface) { return surface.rule == rule.name; }))
            out.idle_rules.push_back(rule.name);
}

bool wants_levels_of_detail(const ScenarioConfig& scenario) {
    const std::vector<RenderQuality> lower = lower_levels(scenario);
    return scenario.quality.render.lod_error_px > 0 ||
           std::any_of(lower.begin(), lower.end(), [](const RenderQuality& q) { return q.lod_error_px > 0; });
}

// Applies the object's table of albedos to the mesh. Returns the factor for its materials.
double paint(Mesh& mesh, const ObjectConfig& config) {
    if (!config.has_albedo_file) return 1;
    const Progress progress("albedos of " + config.name);
    const auto reference =
        config.has_albedo_reference ? std::optional(config.albedo_reference) : std::nullopt;
    return loaded_for(config.albedo_where, [&] {
        return paint_albedos(mesh, read_albedos(config.albedo_file), reference, config.albedo_file.string());
    });
}

// Refuses a factor with which a surface would reflect more light than it receives: by its material's own
// rule, or else by its reflectance.
void require_darkness(const MeshSurface& surface, const Material& material, double factor,
                      const ObjectConfig& config, const SpectralGrid& grid) {
    const auto refuse = [&](const std::string& why) {
        throw InputError(
            fmt::format("{}: its greatest albedo is {:.4g} times the reference, which is too bright "
                        "for the material of the surface {}: {}; accepted: a darker material, or "
                        "another albedo_reference",
                        config.albedo_where, factor, in_quotes(surface.name), why));
    };
    if (factor * reflectance_of(material, grid) > 1) refuse("it would create light");
    const SurfaceConfig* const rule = find_surface(config.materials.surfaces, surface.name);
    if (!rule) return;
    MaterialConfig scaled = rule->material;
    for (double& value : scaled.reflectance.value) value *= factor;
    try {
        validate(scaled);
    } catch (const InputError& problem) {
        refuse(problem.what());
    }
}

void brighten(SceneObject& object, double factor, const ObjectConfig& config, const SpectralGrid& grid) {
    for (std::size_t s = 0; s < object.materials.size(); ++s) {
        Material& material = object.materials[s];
        require_darkness(object.mesh.surfaces[s], material, factor, config, grid);
        const auto scale = static_cast<float>(factor);
        material.base = scale * material.base;
        if (material.is_bare()) material.highlight = scale * material.highlight;
    }
}

void scale_mesh(Mesh& mesh, float factor) {
    for (Vec3f& vertex : mesh.vertices_m) vertex = factor * vertex;
}

// Scales a mesh in units far from metres to about a metre, by a power of two, because floats cannot hold its
// squared areas. Returns the factor back to the original size.
double bring_near_one(Mesh& mesh) {
    constexpr int kFar = 20;  // powers of two
    float greatest = 0;
    for (const Vec3f v : mesh.vertices_m)
        greatest = std::max({greatest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (!(greatest > 0) || !std::isfinite(greatest)) return 1;
    const int exponent = std::ilogb(greatest);
    if (std::abs(exponent) <= kFar) return 1;
    for (Vec3f& v : mesh.vertices_m)
        v = {std::ldexp(v.x, -exponent), std::ldexp(v.y, -exponent), std::ldexp(v.z, -exponent)};
    return std::ldexp(1.0, exponent);
}

// An object with mesh and levels at the size of the mesh's file, except for bring_near_one(). Objects of all
// sizes share what is derived from them; `scale` brings them to the object's size.
struct UnscaledObject {
    SceneObject object;
    float scale = 1;
};

UnscaledObject make_object(Mesh mesh, const ObjectConfig& config, const ScenarioConfig& scenario,
                           const SpectralGrid& grid, LoadedObject& found) {
    UnscaledObject out;
    SceneObject& object = out.object;
    object.mesh = std::move(mesh);
    out.scale = static_cast<float>(config.scale * bring_near_one(object.mesh));
    const double brightest = paint(object.mesh, config);
    // In a coarser level, a vertex would have the albedo of one of many facets, or the colour of one of many
    // corners, instead of their mean.
    if (wants_levels_of_detail(scenario) && !config.has_albedo_file && object.mesh.colors.empty()) {
        const Progress progress("levels of detail of " + config.name);
        object.levels = cached_levels(object.mesh, user_cache(!scenario.is_used_once));
    }
    object.materials = load_materials(object.mesh, config, grid);
    tell(object.mesh, out.scale, object.materials, config, grid, found);
    if (config.has_albedo_file) brighten(object, brightest, config, grid);
    return out;
}

void scale_object(SceneObject& object, float factor) {
    if (factor == 1) return;
    scale_mesh(object.mesh, factor);
    for (MeshLevel& level : object.levels) {
        scale_mesh(level.mesh, factor);
        level.error_m *= static_cast<double>(factor);
    }
}

// Objects with the same result have the same meshes and looks, whatever their places and motions.
std::string make_of(const ObjectConfig& config) {
    std::string make = fmt::format("{}\n{}\n{}\n{}\n{}\n", mesh_name_of(config), config.scale,
                                   config.mesh_surface, config.albedo_file.string(), config.albedo_reference);
    for (const JointConfig& joint : config.joints) make += joint.node + "\n";
    MaterialSet materials = config.materials;
    return make + section_listing(section_of(materials));
}

// Throws InputError for a mesh that is larger than the Sun at its object's scale, because squares of its
// facets' areas would exceed single precision.
void require_size(const Mesh& mesh, double scale, const std::filesystem::path& file) {
    constexpr double kLargest_m = 1e9;
    for (const Vec3f& vertex : mesh.vertices_m)
        if (const Vec3d place_m = scale * to_double(vertex); !is_within(place_m, kLargest_m))
            throw refused(
                file.string(),
                fmt::format("a vertex {:g} m from the mesh's origin, by the object's scale", length(place_m)),
                "at most 1e9 m");
}

std::vector<Mesh> load_meshes(const ObjectConfig& config, const std::vector<std::string>& nodes,
                              const Cache& cache) {
    const HeldFile file = mesh_file_of(config, cache);
    const Progress progress("mesh " + file.path().filename().string());
    return loaded_for(config.mesh_where, [&] {
        std::vector<Mesh> meshes = load_mesh_parts(
            file.path(), nodes,
            config.has_mesh_surface ? std::optional(static_cast<int>(config.mesh_surface)) : std::nullopt);
        for (const Mesh& mesh : meshes) require_size(mesh, config.scale, file.path());
        return meshes;
    });
}

// Returns the objects in order, then all their parts on joints, as WorldState places them. The first of each
// kind is loaded, and the others share it.
std::vector<UnscaledObject> unscaled_objects(const ScenarioConfig& scenario, const SpectralGrid& grid,
                                             std::vector<LoadedObject>& found) {
    found.assign(scenario.objects.size(), {});
    std::vector<UnscaledObject> objects(scenario.objects.size());
    const Cache cache = user_cache(!scenario.is_used_once);
    struct Loaded {
        std::size_t object, first_part;
    };
    std::map<std::string, Loaded> loaded;
    Progress progress("loading the objects", static_cast<double>(scenario.objects.size()));
    for (std::size_t i = 0; i < scenario.objects.size(); ++i) {
        const ObjectConfig& config = scenario.objects[i];
        progress.done(static_cast<double>(i));
        const auto [make, is_new] = loaded.try_emplace(make_of(config), Loaded{i, objects.size()});
        std::vector<std::string> nodes;
        for (const JointConfig& joint : config.joints) nodes.push_back(joint.node);
        if (is_new) {
            std::vector<Mesh> meshes = load_meshes(config, nodes, cache);
            objects[i] = make_object(std::move(meshes.front()), config, scenario, grid, found[i]);
            for (std::size_t k = 1; k < meshes.size(); ++k)
                objects.push_back(make_object(std::move(meshes[k]), config, scenario, grid, found[i]));
        } else {
            objects[i].object.like = make->second.object;
            for (std::size_t k = 0; k < nodes.size(); ++k)
                objects.emplace_back().object.like = make->second.first_part + k;
            found[i] = found[make->second.object];
        }
        found[i].name = config.name;
        SceneObject& whole = objects[i].object;
        whole.name = config.name;
        whole.turn_rate_rad_s = length(config.pose.rate_body_rad_s);
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            SceneObject& part = objects[objects.size() - nodes.size() + k].object;
            part.name = config.name + "/" + nodes[k];
            part.turn_rate_rad_s = whole.turn_rate_rad_s + std::abs(config.joints[k].rate_rad_s);
        }
    }
    return objects;
}

}  // namespace

void load_objects(const ScenarioConfig& scenario, const SpectralGrid& grid, LightLoading& light, Scene& scene,
                  std::vector<LoadedObject>& found) {
    std::vector<float> scales;
    for (UnscaledObject& one : unscaled_objects(scenario, grid, found)) {
        scene.objects.push_back(std::move(one.object));
        scales.push_back(one.scale);
    }
    load_tables(scene, scales, scenario, light);
    for (std::size_t i = 0; i < scales.size(); ++i) scale_object(scene.objects[i], scales[i]);
}

Mesh load_whole_mesh(const ObjectConfig& config) {
    Mesh mesh = std::move(load_meshes(config, {}, user_cache()).front());
    scale_mesh(mesh, static_cast<float>(config.scale));
    return mesh;
}

double LoadedObject::mean_reflectance() const {
    double area_m2 = 0, sum_m2 = 0;
    for (const LoadedSurface& surface : surfaces)
        area_m2 += surface.area_m2, sum_m2 += surface.area_m2 * surface.reflectance;
    return area_m2 > 0 ? sum_m2 / area_m2 : 0;
}

Spectrum LoadedObject::mean_emission() const {
    double area_m2 = 0;
    Spectrum sum;
    for (const LoadedSurface& surface : surfaces) {
        area_m2 += surface.area_m2;
        sum += static_cast<float>(surface.area_m2) * surface.emission;
    }
    return area_m2 > 0 ? static_cast<float>(1 / area_m2) * sum : Spectrum{};
}

}  // namespace hilcam
