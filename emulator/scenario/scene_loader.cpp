#include "emulator/scenario/scene_loader.h"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "emulator/ground/body_loader.h"
#include "emulator/ground/earth_loader.h"
#include "emulator/ground/globe_loader.h"
#include "emulator/progress/progress.h"
#include "emulator/progress/user_cache.h"
#include "emulator/scenario/lamp_setup.h"
#include "emulator/scenario/scenario_listing.h"
#include "io/cache/atmosphere_cache.h"
#include "io/cache/generated_mesh.h"
#include "io/cache/level_cache.h"
#include "io/config/config_advice.h"
#include "io/files/albedo_file.h"
#include "io/files/atmosphere_file.h"
#include "io/files/brdf_file.h"
#include "io/files/catalogue_file.h"
#include "io/files/mesh_file.h"
#include "io/pictures/picture_file.h"
#include "render/background/body_albedo.h"
#include "render/brdf/brdf_table.h"
#include "render/earth/air_from_space.h"
#include "render/earth/earth_albedo.h"
#include "render/earth/earth_model.h"
#include "render/frame/plugin.h"
#include "render/ground/terrain_patch.h"
#include "render/scene/brdf.h"
#include "render/sky/motion_bounds.h"
#include "render/sky/own_bodies.h"
#include "render/sky/sun.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/units.h"

namespace hilcam {

namespace {

std::vector<std::string> arguments_of(const GeneratedMeshConfig& g) {
    std::string angle = std::to_string(g.wing_angle_deg);
    angle.resize(angle.find('.') + 3);
    return {"--triangles", std::to_string(g.triangles), "--seed", std::to_string(g.seed),
            "--wing-angle-deg=" + angle};
}

// The file of an object's mesh, which is made if need be.
HeldFile mesh_file_of(const ObjectConfig& object, const Cache& cache) {
    if (object.has_mesh) return {object.mesh, {}, {}};
    return generated_mesh(object.generate.value().program, arguments_of(*object.generate), cache);
}

}  // namespace

std::string mesh_name_of(const ObjectConfig& object) {
    if (object.has_mesh) return object.mesh.string();
    return generated_mesh_name(object.generate.value().program, arguments_of(*object.generate));
}

namespace {

Material load_material(const MaterialConfig& m, const SpectralGrid& grid) {
    return make_material(
        m, grid, m.table.empty() ? nullptr : std::make_shared<const BrdfTable>(read_brdf(m.table, grid)));
}

std::vector<Material> load_materials(const Mesh& mesh, const MaterialSet& set, const SpectralGrid& grid) {
    std::vector<Material> materials;
    for (const MeshSurface& surface : mesh.surfaces) {
        const SurfaceConfig* config = find_surface(set.surfaces, surface.name);
        if (!config) {
            materials.push_back(make_material(surface, grid));
            continue;
        }
        materials.push_back(load_material(config->material, grid));
        materials.back().texture = surface.base_color_texture;
    }
    return materials;
}

template <class F>
Vec3d by_component(Vec3d a, Vec3d b, const F& f) {
    return {f(a.x, b.x), f(a.y, b.y), f(a.z, b.z)};
}

// Adds a mesh, which is so many times as large, with its materials, to what was found of the object that it is or
// is a part of.
void tell(const Mesh& mesh, float scale, const std::vector<Material>& materials, const ObjectConfig& config,
          const SpectralGrid& grid, LoadedObject& out) {
    const bool first = out.surfaces.empty();
    if (first) out.left_out = mesh.left_out;
    if (first)
        for (std::size_t i = 0; i < mesh.surfaces.size(); ++i) {
            const SurfaceConfig* rule = find_surface(config.materials.surfaces, mesh.surfaces[i].name);
            out.surfaces.push_back(
                {mesh.surfaces[i].name, 0, 0, rule ? rule->name : "", reflectance_of(materials[i], grid)});
        }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        std::array<Vec3d, 3> corner;
        for (std::size_t k = 0; k < 3; ++k) {
            corner[k] = to_double(scale * mesh.vertices_m[mesh.triangles[i][k]]);
            if (out.triangles == 0 && k == 0) out.least_m = out.most_m = corner[k];
            out.least_m =
                by_component(out.least_m, corner[k], [](double a, double b) { return std::min(a, b); });
            out.most_m =
                by_component(out.most_m, corner[k], [](double a, double b) { return std::max(a, b); });
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

// An error in a file stands where the scenario names it.
template <class Load>
auto loaded_for(const std::string& key_where, const Load& load) {
    try {
        return load();
    } catch (const InputError& error) {
        if (key_where.empty()) throw;
        throw InputError(key_where + ": " + error.what());
    }
}

// Puts the object's table of albedos onto the mesh. Returns what its materials are to be multiplied with.
double paint(Mesh& mesh, const ObjectConfig& config) {
    if (!config.has_albedo_file) return 1;
    const Progress progress("albedos of " + config.name);
    const auto reference =
        config.has_albedo_reference ? std::optional(config.albedo_reference) : std::nullopt;
    return loaded_for(config.albedo_where, [&] {
        return paint_albedos(mesh, read_albedos(config.albedo_file), reference, config.albedo_file.string());
    });
}

// Refuses a factor with which a surface would send back more light than it gets: by its material's own rule, else by
// what it reflects.
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

// Brings a mesh whose file has other units than metres, by far, to the size of a metre, by a power of two: floats do
// not hold its squared areas. Returns the factor to what it was.
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

// An object whose mesh and levels are as large as the mesh's file has them, but for bring_near_one(): objects of all
// sizes share what is made of them. `scale` brings them to the object's size.
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
    // A level's vertices would each have the albedo of one of many facets, or the colour of one of many corners, not their mean.
    if (wants_levels_of_detail(scenario) && !config.has_albedo_file && object.mesh.colors.empty()) {
        const Progress progress("levels of detail of " + config.name);
        object.levels = cached_levels(object.mesh, user_cache(!scenario.is_used_once));
    }
    object.materials = load_materials(object.mesh, config.materials, grid);
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

// Objects of one make have the same meshes and the same looks, wherever they are and however they turn.
std::string make_of(const ObjectConfig& config) {
    std::string make = fmt::format("{}\n{}\n{}\n{}\n{}\n", mesh_name_of(config), config.scale,
                                   config.mesh_surface, config.albedo_file.string(), config.albedo_reference);
    for (const JointConfig& joint : config.joints) make += joint.node + "\n";
    MaterialSet materials = config.materials;
    return make + section_listing(section_of(materials));
}

// Throws InputError for a mesh that is larger than the Sun at its object's scale: the squares of its facets' areas
// would leave single precision.
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

// The objects in their order, then all their turning parts: as WorldState places them. The first of a make is
// loaded, the others are like it.
std::vector<UnscaledObject> load_objects(const ScenarioConfig& scenario, const SpectralGrid& grid,
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

// Puts the objects into the scene, at their sizes and with their tables of directions.
void add_objects(std::vector<UnscaledObject> objects, const ScenarioConfig& scenario, LightLoading& light,
                 Scene& scene) {
    std::vector<float> scales;
    for (UnscaledObject& one : objects) {
        scene.objects.push_back(std::move(one.object));
        scales.push_back(one.scale);
    }
    load_tables(scene, scales, scenario, light);
    for (std::size_t i = 0; i < scales.size(); ++i) scale_object(scene.objects[i], scales[i]);
}

// A frame's radiance is the largest of all images: where it alone does not fit, nothing is begun.
void require_room(const SpectralGrid& grid, const ImageGeometry& g) {
    constexpr double kGigabyte = 1e9;
    const double frame_gb =
        1.0 * g.padded_width() * g.padded_height() * grid.size() * sizeof(float) / kGigabyte;
    const double machine_gb = 1.0 * static_cast<double>(sysconf(_SC_PHYS_PAGES)) *
                              static_cast<double>(sysconf(_SC_PAGESIZE)) / kGigabyte;
    if (frame_gb > machine_gb)
        throw InputError(
            fmt::format("camera.width_px, height_px: a frame of {} x {} pixels (guard_px and oversampling "
                        "included) in {} "
                        "spectral bins takes {:.1f} GB; accepted: less than this machine's memory, {:.1f} GB",
                        g.padded_width(), g.padded_height(), grid.size(), frame_gb, machine_gb));
}

BodyId body_named(const ScenarioConfig& s, const std::string& name) {
    std::vector<std::string> names(kBodyNames.begin(), kBodyNames.end());
    for (const OwnBodyConfig& own : s.own_bodies) names.push_back(own.name);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
        throw refused("terrain.globe.body", in_quotes(name), fmt::format("{}", fmt::join(names, ", ")));
    return static_cast<BodyId>(found - names.begin());
}

std::unique_ptr<SceneTerrain> load_terrain(const ScenarioConfig& s, const SpectralGrid& grid) {
    const TerrainConfig& t = *s.terrain;
    const Progress progress("terrain " + t.name);
    auto terrain = std::make_unique<SceneTerrain>();
    terrain->material = load_material(t.material, grid);
    if (t.globe) {
        terrain->body = body_named(s, t.globe->body);
        terrain->ground = load_globe(*t.globe, ground_body(s), terrain->material);
    } else {
        const TimeTai time = parse_utc(s.time_utc);
        terrain->ground = std::make_unique<TerrainPatch>(open_height_map(*t.heights), t.radius_m);
        terrain->pose = initial_motion(t.pose, time, bodies_at(time, s.origin)).pose;
        if (t.place) terrain->body = t.place->body, terrain->place = t.place->place;
    }
    terrain->name = t.name;
    terrain->edge_px = t.edge_px;
    terrain->most_triangles = static_cast<std::size_t>(t.most_triangles);
    terrain->wait = t.wait;
    return terrain;
}

void load_bodies(const ScenarioConfig& scenario, const SpectralGrid& grid, Scene& scene) {
    for (std::size_t i = 0; i < kBodyCount; ++i)
        scene.bodies[i] = load_body(static_cast<BodyId>(i), std::string(kBodyNames[i]), kFigures[i],
                                    scenario.bodies[i], grid);
    for (std::size_t k = 0; k < scenario.own_bodies.size(); ++k) {
        const OwnBodyConfig& own = scenario.own_bodies[k];
        scene.bodies[kBodyCount + k] = load_body(static_cast<BodyId>(kBodyCount + k), own.name,
                                                 scenario.origin.own->list[k].figure, own.look, grid);
        scene.bodies[kBodyCount + k].name = own.name;
    }
}

void load_air_and_earth(const ScenarioConfig& scenario, const SpectralGrid& grid, const Modules& modules,
                        Scene& scene) {
    if (!scene.body(BodyId::kEarth).visible) return;
    const AtmosphereConfig& air = scenario.atmosphere;
    const AtmosphereCache cache(user_cache_at(air.cache, !scenario.is_used_once));
    std::optional<AtmosphereTable> table;
    if (!air.table.empty()) table = read_atmosphere(air.table, grid);
    const EarthConfig& surface = scenario.earth_surface;
    std::optional<EarthMaps> maps;
    if (!surface.map.empty()) {
        const Progress earth("Earth's maps");
        maps.emplace(load_earth_maps(surface));
    }
    {
        const Progress progress("air");
        scene.air = modules.atmospheres.make(air.model,
                                             AtmosphereRequest{air, grid, table ? &*table : nullptr, &cache});
        if (auto* by_place = dynamic_cast<AirByPlace*>(scene.air.get()); by_place && !air.has_ground_albedo)
            by_place->put_over(maps ? earth_albedo(surface, maps->ground, maps->clouds, grid)
                                    : body_albedo(scene.body(BodyId::kEarth), grid));
    }
    if (maps) {
        const Progress earth("Earth");
        scene.earth = make_earth(surface, std::move(*maps), scene.air.get(), grid);
    } else if (air.model == "precomputed") {
        scene.air = looked_up_from_space(std::move(scene.air));
    }
}

}  // namespace

Mesh load_whole_mesh(const ObjectConfig& config) {
    Mesh mesh = std::move(load_meshes(config, {}, user_cache()).front());
    scale_mesh(mesh, static_cast<float>(config.scale));
    return mesh;
}

BodyId ground_body_id(const ScenarioConfig& s) { return body_named(s, s.terrain->globe->body); }

MappedBody ground_body(const ScenarioConfig& s) {
    const std::string& name = s.terrain->globe->body;
    const std::size_t i = index_of(body_named(s, name));
    return {name, i < kBodyCount ? kFigures[i] : s.origin.own->list[i - kBodyCount].figure};
}

double LoadedObject::mean_reflectance() const {
    double area_m2 = 0, sum_m2 = 0;
    for (const LoadedSurface& surface : surfaces)
        area_m2 += surface.area_m2, sum_m2 += surface.area_m2 * surface.reflectance;
    return area_m2 > 0 ? sum_m2 / area_m2 : 0;
}

Scene load_scene(const ScenarioConfig& scenario, const SpectralGrid& grid, const Modules& modules,
                 std::vector<LoadedObject>* found, LightLoading* light) {
    Scene scene;
    std::vector<LoadedObject> objects;
    LightLoading at_once;
    add_objects(load_objects(scenario, grid, found ? *found : objects), scenario, light ? *light : at_once,
                scene);
    const TimeTai time = parse_utc(scenario.time_utc);
    if (scenario.terrain) scene.terrain = load_terrain(scenario, grid);
    scene.lamps = scene_lamps(scenario, grid);
    scene.stars_time = time;
    if (const auto& stars = scenario.stars; stars && !stars->catalogue.empty())
        scene.stars =
            stars_at(loaded_for(stars->catalogue_where, [&] { return load_catalogue(stars->catalogue); }),
                     time, stars->faintest_magnitude, grid);
    load_bodies(scenario, grid, scene);
    load_air_and_earth(scenario, grid, modules, scene);
    if (scenario.sun.has_spectrum) require_cover(scenario.sun.spectrum, grid, "sun.spectrum");
    scene.sun_irradiance_1au_w_m2_um = scenario.sun.has_spectrum
                                           ? grid.average(scenario.sun.spectrum)
                                           : loaded_for(scenario.places.of("spectrum_edges_um"),
                                                        [&] { return solar_irradiance_1au_w_m2_um(grid); });
    scene.limb_darkening = scenario.sun.limb_darkening;
    return scene;
}

std::unique_ptr<Renderer> load_renderer(const ScenarioConfig& scenario, const SpectralGrid& grid,
                                        const ImageGeometry& geometry, std::vector<LoadedObject>* found,
                                        LightLoading* light) {
    require_room(grid, geometry);
    Modules modules;
    std::vector<std::filesystem::path> plugins;
    for (const PluginConfig& plugin : scenario.plugins) plugins.push_back(plugin.file);
    load_plugins(plugins, modules);
    return std::make_unique<Renderer>(load_scene(scenario, grid, modules, found, light), grid, geometry,
                                      render_quality_of(scenario), models_of(scenario), modules,
                                      lower_levels(scenario));
}

DetectorPictures load_detector_pictures(const CameraModel& camera) {
    const FixedPatternConfig& config = camera.fixed_pattern;
    DetectorPictures out;
    if (!config.prnu_map.empty()) out.prnu = read_pixel_map(config.prnu_map, false);
    if (!config.offset_map.empty()) out.offset_e = read_pixel_map(config.offset_map, true);
    if (!config.dark_map.empty()) out.dark_e_s = read_pixel_map(config.dark_map, false);
    return out;
}

}  // namespace hilcam
