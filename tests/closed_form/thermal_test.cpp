// Light that surfaces emit by their temperature, against Planck's law and closed forms of exchange.
#include <gtest/gtest.h>

#include "render/brdf/brdf_models.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

constexpr double kRoom_k = 300;

// A stage of thermal bins, without sunlight.
Stage thermal_stage(const std::string& path_model, double half_width = 0.3) {
    Stage s;
    s.grid = SpectralGrid({8, 10, 14});
    s.models.radiance = "emissive";
    s.quality.path_model = path_model;
    s.quality.contribution_threshold = 0;
    s.camera(32, half_width);
    s.scene.sun_irradiance_1au_w_m2_um = {};
    return s;
}

MaterialConfig grey(std::size_t model, double emissivity, double kelvin) {
    MaterialConfig m;
    m.model = model;
    m.roughness = 0.6;
    m.infrared_emissivity = Curve::constant(emissivity), m.has_infrared_emissivity = true;
    m.temperature_k = kelvin;
    return m;
}

// Inside a closed room at one temperature everything looks like a black body: walls that reflect half of it, and
// a cube of any material that reflects nearly all.
TEST(Thermal, ACavityAtOneTemperatureIsBlack) {
    for (const std::size_t model : {kModel<brdf::Lambert>, kModel<brdf::Metal>, kModel<brdf::OrenNayar>}) {
        Stage s = thermal_stage("path");
        s.quality.max_depth = 48;
        s.quality.samples_per_axis = 8;
        s.add(cube(grey(kModel<brdf::Lambert>, 0.5, kRoom_k), s.grid, 4), {0.2, 0.1, 0.3}, {0.1, 0.2, 0.3});
        s.add(cube(grey(model, 0.2, kRoom_k), s.grid, 0.5), {0, 0, 1.4}, {0.4, 0.3, 0.2});
        s.render();
        EXPECT_NEAR(s.mean() / static_cast<double>(planck_w_m2_sr_um(s.grid, kRoom_k)[0]), 1, 0.005)
            << BrdfModels::kNames[model];
    }
}

// Two parallel unit squares a metre apart exchange 0.199825 of what one sends (Hamilton & Morgan 1952): a cold,
// grey one before a hot, black one sends rho F E / pi on the average of its area.
TEST(Thermal, ParallelSquaresExchangeByHamiltonAndMorgan) {
    // Cached light is interpolated between places.
    for (const auto& [path_model, tolerance] : {std::pair{"path", 0.004}, {"cached", 0.01}}) {
        Stage s = thermal_stage(path_model, 0.5 / 0.999);
        s.quality.max_depth = 2;
        s.quality.samples_per_axis = 16;
        constexpr double kReflectance = 0.4;
        const auto square = [&](const MaterialConfig& material) {
            return object_of({{-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}, {-0.5f, 0.5f, 0}},
                             {{0, 1, 2}, {0, 2, 3}}, material, s.grid);
        };
        // The camera stands just before the hot square and sees the whole of the cold one.
        s.add(square(grey(kModel<brdf::Lambert>, 1, kRoom_k)), {0, 0, -0.001}, {0, 0, 0});
        s.add(square(grey(kModel<brdf::Lambert>, 1 - kReflectance, 0)), {0, 0, 0.999});
        s.render();
        const double black = static_cast<double>(planck_w_m2_sr_um(s.grid, kRoom_k)[0]);
        EXPECT_NEAR(s.mean() / (kReflectance * black), 0.199825, tolerance * 0.199825) << path_model;
    }
}

// The Earth as an even body of 254 K fills the view.
TEST(Thermal, AnEvenEarthHasItsRadiance) {
    Stage s = thermal_stage("direct");
    s.earth(0.3);
    s.world.bodies[BodyId::kEarth].world_m = {0, 0, 4e7};
    s.camera(32, 0.05);
    s.render();
    EXPECT_NEAR(s.mean() / static_cast<double>(planck_w_m2_sr_um(s.grid, 254)[0]), 1, 2e-3);
}

// White paint with the Earth above it: the Earth's exitance times its solid angle's projection, sin^2 of its
// half angle, times what the paint reflects.
TEST(Thermal, TheEarthsHeatIsReflected) {
    Stage s = thermal_stage("path");
    s.quality.max_depth = 2;
    s.quality.samples_per_axis = 4;
    s.earth(0.3);
    constexpr double kEarthDistance_m = 2 * kEarthEquatorialRadius_m;
    s.world.bodies[BodyId::kEarth].world_m = {0, 0, -kEarthDistance_m};
    s.add(plate(grey(kModel<brdf::Lambert>, 0.4, 0), s.grid), {0, 0, 1});
    s.render();
    const double expected = 0.6 * static_cast<double>(planck_w_m2_sr_um(s.grid, 254)[0]) / 4;
    EXPECT_NEAR(s.mean() / expected, 1, 0.01);
}

}  // namespace
}  // namespace hilcam
