// How large: things from a micrometre to an astronomical unit, and a body under the camera.

#include "tests/extremes/convex_truth.h"
#include "tests/extremes/groups.h"

namespace hilcam::extremes {
namespace {

// A million au away, with the light of one: its rays are parallel even to the largest.
constexpr double kSun_au = 1e6;

// Seen from ten times its size.
Stage cube_of_size(double size_m) {
    Stage s;
    s.camera(256, 0.128);
    s.quality.samples_per_axis = 4;
    s.add(cube(lambert(0.8), s.grid, static_cast<float>(size_m)), {0, 0, 10 * size_m}, {0.4, 0.7, 0.2});
    s.world.bodies.sun_world_m = s.world.objects[0].position_world_m +
                                 kSun_au * kAstronomicalUnit_m * normalized(Vec3d{0.5, -0.4, -1});
    return s;
}
Stage over_the_moon(double height_m, Vec3d look) {
    Stage s;
    BodyConfig config;
    config.albedo = Curve::constant(0.2);
    s.scene.body(BodyId::kMoon) = {true, BodyLook(BodyId::kMoon, config, s.grid), {}};
    s.world.bodies[BodyId::kMoon].world_m = {
        0, 0, kFigures[index_of(BodyId::kMoon)].equatorial_radius_m + height_m};
    s.world.camera.world_from_body = look_along(look, {1, 0, 0.1});
    s.camera(64, 0.05);
    s.quality.samples_per_axis = 4;
    s.sun({0, 0, -1});
    return s;
}

}  // namespace

Group size_of_everything() {
    Group group{"SizeOfEverything",
                "Size: a cube from ten times its size away",
                "size of the cube",
                {"irradiance [W m^-2 um^-1]", "centroid, x [px]"},
                "as of the cube of 1 m: the picture does not depend on the scale.",
                "as of the cube of 1 m, 4 x 4 rays a pixel.",
                {}};
    for (const double size_m : {1e-6, 1e-3, 0.01, 1.0, 1e3, 1e6, 1e9, kAstronomicalUnit_m}) {
        const double size = static_cast<double>(static_cast<float>(size_m)),
                     radius_m = std::sqrt(0.75) * size;
        const Stage s = cube_of_size(size);
        group.cases.push_back({text(size_m) + " m", limits_of(s, cube_truth(s, size, 0.8), radius_m), [size] {
                                   Stage stage = cube_of_size(size);
                                   for (int b = 0; b < 2; ++b)
                                       stage.scene.sun_irradiance_1au_w_m2_um[b] *=
                                           static_cast<float>(kSun_au * kSun_au);
                                   stage.quality.path_model = "direct";
                                   stage.render();
                                   return compared(stage, cube_truth(stage, size, 0.8));
                               }});
    }
    return group;
}

Group height_over_the_moon() {
    Group group{
        "HeightOverTheMoon",
        "Size: a camera over the Moon",
        "height",
        {"radiance straight down [W m^-2 sr^-1 um^-1]", "the horizon's dip [px of 1.5625 mrad]"},
        "albedo E / pi under a Sun overhead; a dip of acos(R / (R + h)).",
        "8 roundings to single precision, and the Sun's distance, which is that of the Moon's centre: 2 R / "
        "au; 4.5 standard "
        "deviations of what 4 x 4 rays a pixel can know of an edge of 64 px, the Sun's angle at the horizon, "
        "and the horizon's own curve.",
        {}};
    constexpr double kRadius_m = 1737.4e3, kFocal_px = 640, kStep_px = 0.25;
    for (const double height_m : {0.1, 1.0, 10.0, 100.0, 1e3}) {
        const double dip = std::acos(kRadius_m / (kRadius_m + height_m)), dip_px = kFocal_px * std::tan(dip);
        // A circle of that dip is a conic in the picture: lower by dip (sqrt(1 + x^2) - 1) at the field's
        // edge.
        const double bend_px = dip_px * (std::sqrt(1 + 0.05 * 0.05) - 1);
        const double edge_px = kSigmas * std::pow(kStep_px, 1.5) * std::sqrt(64.0 / 12) / 64;
        group.cases.push_back(
            {text(height_m) + " m",
             {8 * kFloatGrain + 2 * kRadius_m / kAstronomicalUnit_m,
              edge_px + 32 * (1 - std::cos(dip)) + bend_px},
             [height_m, dip_px] {
                 const double truth = 0.2 * kSun_w_m2_um / kPi;
                 Stage down = over_the_moon(height_m, {0, 0, 1});
                 down.render();
                 Worst radiance;
                 for (const float value : down.radiance.plane(0)) radiance.add(relative(value, truth));
                 Stage level = over_the_moon(height_m, {0, 1, 0});
                 level.render();
                 // The horizon stands across the picture, atan 0.1 off its columns.
                 double lit_px = 0;
                 for (const float value : level.radiance.plane(0)) lit_px += value / truth / 64;
                 const double found_px = (32 - lit_px) / std::sqrt(1.01);
                 return std::vector<Found>{{truth, radiance.value()}, {dip_px, std::abs(found_px - dip_px)}};
             }});
    }
    return group;
}

}  // namespace hilcam::extremes
