#include "emulator/check/ground_sight.h"

#include <algorithm>
#include <cmath>

#include "render/sky/body_photometry.h"
#include "render/sky/sun.h"
#include "render/vocabulary/time.h"
#include "render/vocabulary/units.h"
#include "sensor/optics.h"

namespace hilcam {
namespace {

// Finds the first body along the ray and its distance; nothing: the sky.
std::optional<BodyId> first_body(const ScenarioConfig& s, const Bodies& bodies, Vec3d from_m, Vec3d dir,
                                 double& distance_m) {
    std::optional<BodyId> nearest;
    for (std::size_t i = 0; i < kBodyCount; ++i) {
        if (!s.bodies[i].visible) continue;
        const BodyState& body = bodies.body[i];
        const double met_m = intersect_ellipsoid(kFigures[i], body.fixed_from_world * (from_m - body.world_m),
                                                 body.fixed_from_world * dir);
        if (!(met_m > 0) || (nearest && met_m >= distance_m)) continue;
        nearest = static_cast<BodyId>(i);
        distance_m = met_m;
    }
    return nearest;
}

// Returns the electrons from sunlit ground relative to those from a white Lambert surface that faces the Sun,
// in the camera's band.
double over_white(const BodyLook& look, const CameraModel& camera, const SpectralGrid& band,
                  const GroundSight& ground, double phase_rad) {
    const Spectrum sun = solar_irradiance_1au_w_m2_um(band);
    const Spectrum response = electrons_per_s_per_radiance(camera, band);
    const auto mu0 = static_cast<float>(std::max(0.0, std::sin(ground.sun_elevation_rad)));
    const auto mu = static_cast<float>(std::cos(ground.off_vertical_rad));
    const Spectrum reflected = look.reflectance_sr(mu0, mu, static_cast<float>(std::cos(phase_rad)));
    double sum = 0, of_sun = 0;
    for (int b = 0; b < band.size(); ++b) {
        const double weight = static_cast<double>(response[b]) * static_cast<double>(sun[b]);
        sum += weight * static_cast<double>(reflected[b]);
        of_sun += weight;
    }
    return kPi * sum / of_sun;
}

SpectralGrid band_of(const CameraSheet& sheet) {
    std::vector<double> edges_um;
    for (int i = 0; i <= kMaxBins; ++i)
        edges_um.push_back(sheet.from_um + (sheet.to_um - sheet.from_um) * i / kMaxBins);
    return SpectralGrid(edges_um);
}

}  // namespace

std::optional<GroundSight> ground_sight(const ScenarioConfig& s, const Pose& camera,
                                        const CameraSheet& sheet) {
    const Bodies bodies = bodies_at(parse_utc(s.time_utc), s.origin);
    const Vec3d sight_dir = to_matrix(camera.world_from_body) * Vec3d{0, 0, 1};
    GroundSight out;
    const std::optional<BodyId> id =
        first_body(s, bodies, camera.position_world_m, sight_dir, out.distance_m);
    if (!id) return {};
    const BodyState& body = bodies[*id];
    const Figure& figure = kFigures[index_of(*id)];
    const Vec3d place_m = camera.position_world_m + out.distance_m * sight_dir;
    const Vec3d up = transposed(body.fixed_from_world) *
                     ellipsoid_normal(figure, body.fixed_from_world * (place_m - body.world_m));
    const Vec3d to_sun_m = bodies.sun_world_m - place_m;
    out.body = kBodyNames[index_of(*id)];
    out.pixel_m = sheet.ifov_rad * out.distance_m;
    out.wide_m = 2 * out.distance_m * std::tan(0.5 * std::min(sheet.field_x_rad, 3.0));
    out.high_m = 2 * out.distance_m * std::tan(0.5 * std::min(sheet.field_y_rad, 3.0));
    out.off_vertical_rad = angle_between_rad(-sight_dir, up);
    out.sun_elevation_rad = 0.5 * kPi - angle_between_rad(to_sun_m, up);
    if (s.terrain) return out;
    const SpectralGrid band = band_of(sheet);
    const BodyLook look(*id, s.bodies[index_of(*id)], band);
    const double sun_au = length(to_sun_m) / kAstronomicalUnit_m;
    const double share = over_white(look, sheet.camera, band, out, angle_between_rad(to_sun_m, -sight_dir));
    // The first scene of the sheet is white, at 1 au, and faces the Sun.
    out.expected = read_out(sheet, share * sheet.scenes.front().signal_e / (sun_au * sun_au));
    return out;
}

}  // namespace hilcam
