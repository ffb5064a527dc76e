// The Sun: grazing, behind, near and far.

#include "render/sky/body_photometry.h"
#include "tests/extremes/groups.h"
#include "tests/support/stage.h"

namespace hilcam::extremes {
namespace {

// A white plate that fills the field, `distance_m` before the camera.
Stage plate_stage(double distance_m) {
    Stage s;
    s.quality.max_depth = 1;
    s.camera(64, 0.5 / distance_m);
    s.add(plate(lambert(1), s.grid), {0, 0, distance_m});
    return s;
}

}  // namespace

// No acne: the error is that of the worst pixel.
Group sun_incidence() {
    Group group{
        "SunIncidence",
        "Sun: its angle on a plate, near and far",
        "angle from the plate's normal; distance",
        {"radiance [W m^-2 sr^-1 um^-1]"},
        "E cos(i) / pi (Lambert); the error is that of the worst pixel, over E / pi.",
        "8 roundings to single precision of unit vectors and their product; none for a Sun behind the plate.",
        {}};
    for (const double distance_m : {0.1, 3.0, 1e3, 1e6})
        for (const double angle_deg : {0.0, 45.0, 85.0, 89.0, 89.9, 89.99, 89.999, 90.001, 120.0, 180.0}) {
            if (distance_m != 3 && angle_deg != 45 && angle_deg != 89.99) continue;
            const double angle = angle_deg * kDegree_rad;
            group.cases.push_back({text(angle_deg) + " deg; " + text(distance_m) + " m",
                                   {angle_deg > 90 ? 0 : 8 * kFloatGrain},
                                   [distance_m, angle] {
                                       Stage s = plate_stage(distance_m);
                                       s.world.bodies.sun_world_m =
                                           Vec3d{0, 0, distance_m} +
                                           kAstronomicalUnit_m * Vec3d{std::sin(angle), 0, -std::cos(angle)};
                                       s.render();
                                       const double full = kSun_w_m2_um / kPi;
                                       const double truth = full * std::max(0.0, std::cos(angle));
                                       Worst worst;
                                       for (const float value : s.radiance.plane(0))
                                           worst.add(std::abs(value - truth) / full);
                                       return std::vector<Found>{{truth, worst.value()}};
                                   }});
        }
    return group;
}

// A sphere of geometric albedo 2/3 A and phase function (sin g + (pi - g) cos g) / pi: from full to the
// thinnest crescent. The sphere is the Moon's, 11.6 au away, in a picture where its radius is 100 px.
Group sun_phase() {
    Group group{
        "SunPhase",
        "Sun: the phase of a sphere, 12 au away",
        "phase angle",
        {"irradiance [W m^-2 um^-1]"},
        "Lambert's sphere: 2/3 A (R/d)^2 E (sin g + (pi - g) cos g) / pi.",
        "4.5 standard deviations of what 4 x 4 rays a pixel can know of the bright limb, where the radiance "
        "is "
        "up to sin(g) of the greatest, and one row of rays' share of its curve; 8 roundings to single "
        "precision; the Sun's rays part by R over its distance.",
        {}};
    constexpr double kRadius_px = 100, kStep_px = 0.25;
    const double radius_m = kFigures[index_of(BodyId::kMoon)].equatorial_radius_m;
    const double distance_m = 1e6 * radius_m, sun_m = 100 * kAstronomicalUnit_m;
    for (const double phase_deg : {0.0, 30.0, 60.0, 90.0, 120.0, 150.0, 165.0, 175.0}) {
        const double g = phase_deg * kDegree_rad, phase = lambert_phase(g);
        // In px^2 of the radiance A E / pi; the whole picture has 2/3 pi R^2 phase of them.
        const double all_px2 = 2.0 / 3 * kPi * kRadius_px * kRadius_px * phase;
        const double limb_px2 =
            kSigmas * std::pow(kStep_px, 1.5) * std::sin(g) * std::sqrt(kPi * kRadius_px / 24);
        const double curve_px2 = kStep_px * kStep_px * std::max(0.05, std::cos(0.5 * g));
        const double parted = 2 * radius_m / sun_m / std::max(kPi - g, 1e-3);
        group.cases.push_back(
            {text(phase_deg) + " deg",
             {(limb_px2 + curve_px2) / all_px2 + 8 * kFloatGrain + parted},
             [g, phase, distance_m, sun_m, radius_m] {
                 Stage s;
                 BodyConfig config;
                 config.albedo = Curve::constant(0.6);
                 s.scene.body(BodyId::kMoon) = {true, BodyLook(BodyId::kMoon, config, s.grid), {}};
                 s.world.bodies[BodyId::kMoon].world_m = {0, 0, distance_m};
                 s.world.bodies.sun_world_m =
                     Vec3d{0, 0, distance_m} + sun_m * Vec3d{std::sin(g), 0, -std::cos(g)};
                 s.quality.samples_per_axis = 4;
                 s.camera(256, 1.28e-6);
                 s.render();
                 const double irradiance = kSun_w_m2_um * std::pow(kAstronomicalUnit_m / sun_m, 2);
                 const double truth = 2.0 / 3 * 0.6 * irradiance * phase * std::pow(radius_m / distance_m, 2);
                 return std::vector<Found>{{truth, relative(s.light().irradiance, truth)}};
             }});
    }
    return group;
}

Group sun_distance() {
    Group group{"SunDistance",
                "Sun: its distance",
                "distance",
                {"radiance of a white plate [W m^-2 sr^-1 um^-1]"},
                "E / pi at 1 au, by the square of the distance.",
                "8 roundings to single precision.",
                {}};
    for (const double distance_au : {0.046, 0.3, 1.0, 1.52, 5.2, 10.0, 30.0})
        group.cases.push_back({text(distance_au) + " au", {8 * kFloatGrain}, [distance_au] {
                                   Stage s = plate_stage(3);
                                   s.world.bodies.sun_world_m = {0, 0, 3 - distance_au * kAstronomicalUnit_m};
                                   s.render();
                                   const double truth = kSun_w_m2_um / kPi / (distance_au * distance_au);
                                   Worst worst;
                                   for (const float value : s.radiance.plane(0))
                                       worst.add(relative(value, truth));
                                   return std::vector<Found>{{truth, worst.value()}};
                               }});
    return group;
}

}  // namespace hilcam::extremes
