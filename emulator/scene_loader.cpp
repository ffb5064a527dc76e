#include "emulator/scene_loader.h"

#include "io/catalogue_file.h"
#include "io/image_file.h"
#include "io/mesh_cache.h"
#include "io/mesh_file.h"
#include "render/check.h"

namespace hilcam {
namespace {

std::filesystem::path mesh_path(const ObjectConfig& object) {
    if (object.has_mesh) return object.mesh;
    const GeneratedMeshConfig& g = object.generate;
    std::string angle = std::to_string(g.wing_angle_deg);
    angle.resize(angle.find('.') + 3);
    return generated_mesh(g.program, {"--triangles", std::to_string(g.triangles), "--seed",
                                      std::to_string(g.seed), "--wing-angle-deg=" + angle});
}

}  // namespace

Scene load_scene(const ScenarioConfig& scenario, const SpectralGrid& grid) {
    Scene scene;
    for (const ObjectConfig& config : scenario.objects) {
        SceneObject object;
        object.name = config.name;
        object.mesh = load_mesh(mesh_path(config));
        const auto scale = static_cast<float>(config.scale);
        for (Vec3f& vertex : object.mesh.vertices_m) vertex = scale * vertex;
        object.materials = make_materials(object.mesh, config.materials.surfaces, grid);
        scene.objects.push_back(std::move(object));
    }
    if (!scenario.stars.catalogue.empty())
        scene.stars = stars_at(load_catalogue(scenario.stars.catalogue), parse_utc(scenario.time_utc),
                               scenario.stars.faintest_magnitude, grid);
    scene.earth.visible = scenario.earth.visible;
    scene.earth.albedo = grid.average(scenario.earth.albedo);
    if (!scenario.earth.albedo_map.empty()) scene.earth.map = read_picture(scenario.earth.albedo_map);
    scene.sun_irradiance_1au_w_m2_um = solar_irradiance_1au_w_m2_um(grid);
    return scene;
}

}  // namespace hilcam
