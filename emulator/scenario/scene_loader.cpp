#include "emulator/scenario/scene_loader.h"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <algorithm>
#include <optional>

#include "emulator/ground/body_loader.h"
#include "emulator/ground/earth_loader.h"
#include "emulator/ground/globe_loader.h"
#include "emulator/progress/progress.h"
#include "emulator/progress/user_cache.h"
#include "emulator/scenario/lamp_setup.h"
#include "emulator/scenario/loaded_for.h"
#include "io/cache/atmosphere_cache.h"
#include "io/files/atmosphere_file.h"
#include "io/files/catalogue_file.h"
#include "io/files/defect_list.h"
#include "io/images/picture_file.h"
#include "render/background/body_albedo.h"
#include "render/earth/air_from_space.h"
#include "render/earth/earth_albedo.h"
#include "render/earth/earth_model.h"
#include "render/frame/plugin.h"
#include "render/ground/terrain_patch.h"
#include "render/sky/own_bodies.h"
#include "render/sky/sun.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/units.h"

namespace hilcam {

namespace {

// A frame's radiance is the largest of all images. If that alone does not fit, nothing is begun.
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
    terrain->max_triangles = static_cast<std::size_t>(t.max_triangles);
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

// The models of the Earth's air and ground end at 2.5 um.
void require_no_thermal_air(const ScenarioConfig& s, const SpectralGrid& grid) {
    if (!grid.has_thermal()) return;
    if (s.atmosphere.model != "none")
        throw InputError(
            s.places.at("atmosphere.model", "atmosphere.model: found '" + s.atmosphere.model +
                                                "' with spectrum_edges_um beyond 2.5 um; accepted: none"));
    if (!s.earth_surface.map.empty())
        throw InputError(s.places.at("earth_surface.map",
                                     "earth_surface.map: found with spectrum_edges_um beyond 2.5 um; "
                                     "accepted: none, the Earth is then even (earth.heat)"));
}

void load_air_and_earth(const ScenarioConfig& scenario, const SpectralGrid& grid, const Modules& modules,
                        Scene& scene) {
    if (!scene.body(BodyId::kEarth).visible) return;
    require_no_thermal_air(scenario, grid);
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

BodyId ground_body_id(const ScenarioConfig& s) { return body_named(s, s.terrain->globe->body); }

MappedBody ground_body(const ScenarioConfig& s) {
    const std::string& name = s.terrain->globe->body;
    const std::size_t i = index_of(body_named(s, name));
    return {name, i < kBodyCount ? kFigures[i] : s.origin.own->list[i - kBodyCount].figure};
}

Scene load_scene(const ScenarioConfig& scenario, const SpectralGrid& grid, const Modules& modules,
                 std::vector<LoadedObject>* found, LightLoading* light) {
    Scene scene;
    std::vector<LoadedObject> objects;
    LightLoading at_once;
    load_objects(scenario, grid, light ? *light : at_once, scene, found ? *found : objects);
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
    if (!camera.defects.list.empty()) out.defects = read_defect_list(camera.defects.list);
    return out;
}

}  // namespace hilcam
